#include "solver/model/perez.h"

#include <array>
#include <cstddef>
#include <limits>

namespace clerestory {
namespace {

constexpr double kPi = std::numbers::pi;

/// x1 + x2 Z + Delta (x3 + x4 Z)
using Coefficients = std::array<double, 4>;

constexpr std::array<double, 7> kBinEnds = {1.065, 1.230, 1.500, 1.950, 2.800, 4.500, 6.200};

/// By bin of clearness: a, b, c, d, e. Perez, Seals & Michalsky 1993, table 1.
constexpr std::array<std::array<Coefficients, 5>, 8> kLuminance = {{
    {{{1.3525, -0.2576, -0.269, -1.4366},
      {-0.767, 0.0007, 1.2734, -0.1233},
      {2.8, 0.6004, 1.2375, 1},
      {1.8734, 0.6297, 0.9738, 0.2809},
      {0.0356, -0.1246, -0.5718, 0.9938}}},
    {{{-1.2219, -0.773, 1.4148, 1.1016},
      {-0.2054, 0.0367, -3.9128, 0.9156},
      {6.975, 0.1774, 6.4477, -0.1239},
      {-1.5798, -0.5081, -1.7812, 0.108},
      {0.2624, 0.0672, -0.219, -0.4285}}},
    {{{-1.1, -0.2515, 0.8952, 0.0156},
      {0.2782, -0.1812, -4.5, 1.1766},
      {24.7219, -13.0812, -37.7, 34.8438},
      {-5, 1.5218, 3.9229, -2.6204},
      {-0.0156, 0.1597, 0.4199, -0.5562}}},
    {{{-0.5484, -0.6654, -0.2672, 0.7117},
      {0.7234, -0.6219, -5.6812, 2.6297},
      {33.3389, -18.3, -62.25, 52.0781},
      {-3.5, 0.0016, 1.1477, 0.1062},
      {0.4659, -0.3296, -0.0876, -0.0329}}},
    {{{-0.6, -0.3566, -2.5, 2.325},
      {0.2937, 0.0496, -5.6812, 1.8415},
      {21, -4.7656, -21.5906, 7.2492},
      {-3.5, -0.1554, 1.4062, 0.3988},
      {0.0032, 0.0766, -0.0656, -0.1294}}},
    {{{-1.0156, -0.367, 1.0078, 1.4051},
      {0.2875, -0.5328, -3.85, 3.375},
      {14, -0.9999, -7.1406, 7.5469},
      {-3.4, -0.1078, -1.075, 1.5702},
      {-0.0672, 0.4016, 0.3017, -0.4844}}},
    {{{-1, 0.0211, 0.5025, -0.5119},
      {-0.3, 0.1922, 0.7023, -1.6317},
      {19, -5, 1.2438, -1.9094},
      {-4, 0.025, 0.3844, 0.2656},
      {1.0468, -0.3788, -2.4517, 1.4656}}},
    {{{-1.05, 0.0289, 0.426, 0.359},
      {-0.325, 0.1156, 0.7781, 0.0025},
      {31.0625, -14.5, -46.1148, 55.375},
      {-7.2312, 0.405, 13.35, 0.6234},
      {1.5, -0.6426, 1.8564, 0.5636}}},
}};

/// a + b W + c cos Z + d ln Delta. Perez et al. 1990, table 4.
constexpr std::array<Coefficients, 8> kDiffuseEfficacy = {{
    {97.24, -0.46, 12, -8.91},
    {107.22, 1.15, 0.59, -3.95},
    {104.97, 2.96, -5.53, -8.77},
    {102.39, 5.59, -13.95, -13.9},
    {100.71, 5.94, -22.75, -23.74},
    {106.42, 3.83, -36.15, -28.83},
    {141.88, 1.9, -53.24, -14.03},
    {152.23, 0.35, -45.27, -7.98},
}};

/// a + b W + c exp(5.73 Z - 5) + d Delta. The same table.
constexpr std::array<Coefficients, 8> kDirectEfficacy = {{
    {57.2, -4.55, -2.98, 117.12},
    {98.99, -3.46, -1.21, 12.38},
    {109.83, -4.9, -1.71, -8.81},
    {110.34, -5.84, -1.99, -4.56},
    {106.36, -3.97, -1.75, -6.16},
    {107.19, -1.25, -1.51, -26.73},
    {105.75, 0.77, -1.26, -34.44},
    {101.18, 1.58, -1.1, -8.29},
}};

double sun_zenith_angle(const SkyMeasurement& measured) { return std::clamp(measured.zenith_angle, 0.0, kPi / 2); }

/// Irradiance of the sun outside the atmosphere [W/m2].
double extraterrestrial(const std::optional<int>& day_of_year) {
  constexpr double kSolarConstant = 1367;
  if (!day_of_year) return kSolarConstant;
  const double g = 2 * kPi * (*day_of_year - 1) / 365;
  return kSolarConstant * (1.00011 + 0.034221 * std::cos(g) + 0.00128 * std::sin(g) + 0.000719 * std::cos(2 * g) +
                           0.000077 * std::sin(2 * g));
}

}  // namespace

SkyCondition sky_condition(const SkyMeasurement& measured) {
  const double Z = sun_zenith_angle(measured), elevation_deg = 90 - Z * 180 / kPi;
  const double DHI = measured.diffuse_horizontal, cube = 1.041 * Z * Z * Z;
  SkyCondition sky;
  sky.air_mass = 1 / (std::cos(Z) + 0.15 * std::pow(elevation_deg + 3.885, -1.253));
  if (measured.direct_normal > 0)  // without diffuse light infinite: as clear as can be
    sky.clearness =
        DHI > 0 ? ((DHI + measured.direct_normal) / DHI + cube) / (1 + cube) : std::numeric_limits<double>::infinity();
  sky.brightness = std::clamp(DHI * sky.air_mass / extraterrestrial(measured.day_of_year), 0.01, 0.6);
  while (sky.bin < 7 && sky.clearness >= kBinEnds[static_cast<std::size_t>(sky.bin)]) ++sky.bin;
  return sky;
}

SkyShape perez_shape(const SkyMeasurement& measured) {
  const SkyCondition sky = sky_condition(measured);
  const double Z = sun_zenith_angle(measured);
  double Delta = sky.brightness;
  if (sky.bin >= 1 && sky.bin <= 4) Delta = std::max(Delta, 0.2);
  const auto& table = kLuminance[static_cast<std::size_t>(sky.bin)];
  const auto value = [&](std::size_t parameter) {
    const Coefficients& x = table[parameter];
    return x[0] + x[1] * Z + Delta * (x[2] + x[3] * Z);
  };
  // At the rim of their range the coefficients let b rise to 0 and above: an endless horizon, or no light at all.
  SkyShape shape{value(0), std::min(value(1), -0.01), 1, value(2), value(3), value(4)};
  if (sky.bin == 0) {
    const Coefficients &c = table[2], &d = table[3];
    shape.c = std::exp(std::pow(Delta * (c[0] + c[1] * Z), c[2])) - c[3];
    shape.d = -std::exp(Delta * (d[0] + d[1] * Z)) + d[2] + Delta * d[3];
  }
  return shape;
}

double diffuse_efficacy(const SkyMeasurement& measured) {
  const SkyCondition sky = sky_condition(measured);
  const Coefficients& x = kDiffuseEfficacy[static_cast<std::size_t>(sky.bin)];
  return std::max(0.0, x[0] + x[1] * measured.precipitable_water + x[2] * std::cos(sun_zenith_angle(measured)) +
                           x[3] * std::log(sky.brightness));
}

double direct_efficacy(const SkyMeasurement& measured) {
  const SkyCondition sky = sky_condition(measured);
  const Coefficients& x = kDirectEfficacy[static_cast<std::size_t>(sky.bin)];
  return std::max(0.0, x[0] + x[1] * measured.precipitable_water +
                           x[2] * std::exp(5.73 * sun_zenith_angle(measured) - 5) + x[3] * sky.brightness);
}

double precipitable_water(double dew_point_c) { return std::exp(0.07 * dew_point_c - 0.075); }

}  // namespace clerestory
