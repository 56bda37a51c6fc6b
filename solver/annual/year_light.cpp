#include "solver/annual/year_light.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <numbers>

#include "solver/model/parallel.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

void look_at(const DaylightHour& hour, std::size_t h, const SkyParts& parts, RadianceByHour& radiance,
             std::vector<float>& of_hour) {
  const double sky = luminous_mean(hour.sky.horizontal_irradiance);
  parts.look_at(hour.sky.shape, hour.sky.sun, sky, of_hour);
  for (std::size_t k = 0; k < parts.count(); ++k) radiance.at(k, h) = of_hour[k];
  const double sun = hour.sun_up ? hour.sun_normal_irradiance * std::max(0.0, hour.sun.z) : 0;
  radiance.at(parts.ground(), h) = static_cast<float>((sky + sun) * hour.sky.ground_reflectance / std::numbers::pi);
}

// Sums of four points over sixteen hours stay in registers. Products and sums are rounded one by one, and each hour is
// summed by itself in the order of the coefficients, so wider registers find the same bits.
constexpr std::size_t kPoints = 4, kHours = RadianceByHour::kTogether;

#if defined(__x86_64__)
#define CLERESTORY_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define CLERESTORY_WIDE
#endif
using EightHours = float __attribute__((vector_size(32)));
constexpr std::size_t kVectors = kHours / 8;

/// sum[p][h] += coefficient[k][p] * light[lane[k]][h], for sixteen hours.
CLERESTORY_WIDE void add_light(const float* light, const std::uint32_t* lane,
                               const std::array<float, kPoints>* coefficient, std::size_t count, float (*sum)[kHours]) {
  EightHours s[kPoints][kVectors], L[kVectors];
  std::memcpy(&s, sum, sizeof s);
  for (std::size_t k = 0; k < count; ++k) {
    std::memcpy(&L, light + lane[k] * kHours, sizeof L);
    for (std::size_t p = 0; p < kPoints; ++p)
      for (std::size_t v = 0; v < kVectors; ++v) s[p][v] += coefficient[k][p] * L[v];
  }
  std::memcpy(sum, &s, sizeof s);
}

/// Lanes that any of four points has something of.
struct Gathered {
  std::vector<std::uint32_t> lane;
  std::vector<std::array<float, kPoints>> coefficient;

  template <class Of>
  void gather(std::size_t lanes, std::size_t points, const Of& of) {
    lane.clear(), coefficient.clear();
    for (std::size_t k = 0; k < lanes; ++k) {
      std::array<float, kPoints> x{};
      for (std::size_t p = 0; p < points; ++p) x[p] = of(p)[k];
      if (std::all_of(x.begin(), x.end(), [](float v) { return v == 0; })) continue;
      lane.push_back(static_cast<std::uint32_t>(k)), coefficient.push_back(x);
    }
  }
};

}  // namespace

YearLight light_of_year(std::span<const DaylightHour> hours, const SkyParts& fine, const SkyParts& coarse,
                        const SunNodes& nodes) {
  YearLight year{hours.size(),
                 {fine.count() + 1, hours.size()},
                 {coarse.count() + 1, hours.size()},
                 std::vector<float>(hours.size()),
                 nodes.of_sun};
  parallel_for(hours.size(), 16, [&](std::size_t begin, std::size_t end) {
    std::vector<float> of_fine(fine.count()), of_coarse(coarse.count());
    for (std::size_t h = begin; h < end; ++h) {
      look_at(hours[h], h, fine, year.fine, of_fine);
      look_at(hours[h], h, coarse, year.coarse, of_coarse);
      year.sun[h] = hours[h].sun_up ? static_cast<float>(hours[h].sun_normal_irradiance) : 0.0f;
    }
  });
  return year;
}

void series_of(const YearLight& year, std::span<const PointCoefficients> points, std::span<const float> sun,
               std::span<float> total, std::span<float> direct) {
  constexpr auto kLux = static_cast<float>(kWhiteEfficacy);
  const std::size_t H = year.hours, coarse = year.coarse.parts();
  Gathered straight, reflected;
  for (std::size_t first = 0; first < points.size(); first += kPoints) {
    const std::size_t count = std::min(kPoints, points.size() - first);
    straight.gather(points[first].straight.size(), count,
                    [&](std::size_t p) { return points[first + p].straight.data(); });
    reflected.gather(coarse, count, [&](std::size_t p) { return points[first + p].reflected.data(); });
    for (std::size_t hour = 0; hour < H; hour += kHours) {
      float sum[kPoints][kHours] = {};
      add_light(year.fine.from(hour), straight.lane.data(), straight.coefficient.data(), straight.lane.size(), sum);
      add_light(year.coarse.from(hour), reflected.lane.data(), reflected.coefficient.data(), reflected.lane.size(),
                sum);
      for (std::size_t p = 0; p < count; ++p)
        for (std::size_t h = hour; h < std::min(hour + kHours, H); ++h) {
          const std::size_t at = (first + p) * H + h;
          const float* const of_node = points[first + p].reflected.data() + coarse;
          const AmongNodes& among = year.of_sun[h];
          float by_sun = 0;
          for (std::size_t k = 0; k < among.node.size(); ++k)
            if (among.weight[k] > 0) by_sun += among.weight[k] * of_node[among.node[k]];
          direct[at] = kLux * year.sun[h] * sun[at];
          total[at] = kLux * (sum[p][h - hour] + year.sun[h] * by_sun) + direct[at];
        }
    }
  }
}

}  // namespace clerestory
