#include "solver/particles/sky_directions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr double kSolidAngle = 4 * std::numbers::pi / (128 * 256);  // of a cell
constexpr double kLeast =
    1e-3;  // of the mean radiance: what a cell has at least, whose dark points may not tell it all
constexpr double kLeastCosine = 0.01;

}  // namespace

Vec3 SkyDirections::towards(int cell, double a, double b) {
  const double z = 1 - 2 * (cell / kAzimuths + a) / kHeights;
  const double r = std::sqrt(std::max(0.0, 1 - z * z)), phi = 2 * std::numbers::pi * (cell % kAzimuths + b) / kAzimuths;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

SkyDirections::SkyDirections(const SkyRadiance& sky) : radiance_(kHeights * kAzimuths), of_block_(kBlocks, 0.0) {
  double mean = 0;
  for (int cell = 0; cell < kHeights * kAzimuths; ++cell) {
    double L = 0;
    for (const double a : {0.25, 0.75})
      for (const double b : {0.25, 0.75}) L += luminous_mean(sky(towards(cell, a, b))) / 4;
    radiance_[static_cast<std::size_t>(cell)] = static_cast<float>(L);
    mean += L / (kHeights * kAzimuths);
  }
  for (float& L : radiance_) L = std::max(L, static_cast<float>(kLeast * mean));
  for (int block = 0; block < kBlocks; ++block)
    for (int part = 0; part < kBlock * kBlock; ++part)
      of_block_[static_cast<std::size_t>(block)] += double{radiance_[static_cast<std::size_t>(cell_of(block, part))]};
}

double SkyDirections::irradiance(const Vec3& normal) const {
  double sum = 0;
  for (int cell = 0; cell < kHeights * kAzimuths; ++cell)
    sum += double{radiance_[static_cast<std::size_t>(cell)]} * std::max(0.0, -dot(towards(cell, 0.5, 0.5), normal));
  return sum * kSolidAngle;
}

SkyDirections::Plane::Plane(const SkyDirections& sky, const Vec3& normal) {
  std::vector<double> weight(kBlocks, 0.0);
  for (int block = 0; block < kBlocks; ++block)
    for (int part = 0; part < kBlock * kBlock; ++part) {
      const int cell = cell_of(block, part);
      const double cosine = std::max(0.0, -dot(towards(cell, 0.5, 0.5), normal));
      weight[static_cast<std::size_t>(block)] +=
          double{sky.radiance_[static_cast<std::size_t>(cell)]} * (cosine + kLeastCosine) * kSolidAngle;
    }
  blocks_ = CumulativeTable(weight);
}

Vec3 SkyDirections::Plane::sample(const SkyDirections& sky, double u, double v) const {
  const auto [block, probability, rest] = blocks_.choose(u);
  double left = rest * sky.of_block_[block];
  int part = 0;
  const auto radiance = [&] {
    return double{sky.radiance_[static_cast<std::size_t>(cell_of(static_cast<int>(block), part))]};
  };
  for (; part + 1 < kBlock * kBlock && left >= radiance(); ++part) left -= radiance();
  return -towards(cell_of(static_cast<int>(block), part), std::min(left / radiance(), 1.0), v);
}

double SkyDirections::Plane::density(const SkyDirections& sky, const Vec3& travel) const {
  const auto place = [](double x, int n) { return std::clamp(static_cast<int>(x * n), 0, n - 1); };
  const double turn = std::atan2(-travel.y, -travel.x) / (2 * std::numbers::pi);
  const int row = place((1 + travel.z) / 2, kHeights), column = place(turn < 0 ? turn + 1 : turn, kAzimuths);
  const auto block = static_cast<std::size_t>(row / kBlock * (kAzimuths / kBlock) + column / kBlock);
  const double radiance = double{sky.radiance_[static_cast<std::size_t>(row * kAzimuths + column)]};
  return blocks_.probability(block) * radiance / sky.of_block_[block] / kSolidAngle;
}

}  // namespace clerestory
