#include "solver/illumination/caustic_light.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <numbers>

#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/units.h"
#include "solver/sampling/plane_kernel.h"
#include "solver/visibility/discs.h"

namespace clerestory {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr KernelShape kShape = KernelShape::epanechnikov;
constexpr double kLargest = 1.0 / 40;     // h over the scene's diameter
constexpr std::size_t kPilot = 1 << 14;   // legs that tell how dense they are
constexpr int kRadii = 12;                // steps of sqrt(1/2) in h that a pilot tells apart
constexpr unsigned kFewest = 16;          // legs of the pilot that tell a density
constexpr std::size_t kDirections = 32;   // that a point looks along its plane
constexpr std::size_t kBlock = 1 << 12;   // legs of a task
constexpr double kBeyond = 2e-6;          // of the diameter: legs pass the discs of the surface that they end on
constexpr std::size_t kAtOnce = 1 << 21;  // of what they find, about: 64 MB
constexpr std::size_t kRound = 64;        // tasks before what they found is summed

/// What a point sees of its plane: a polygon around it, and the kernel on that.
struct Kernel {
  Frame frame;
  Vec3 centre;
  double h;
  bool is_whole = true;
  std::array<float, kDirections> reach{};  ///< by direction, over h
  std::array<double, 3> weight;            ///< a and b, in units of h

  Kernel(const RayScene& rays, const ReceivingPoint& at, double radius) : frame(at.n), centre(at.p), h(radius) {
    // A little beyond the kernel, so that the sides of an open polygon pass outside of it.
    const double most = 1 / std::cos(kPi / kDirections) + 1e-6;
    for (std::size_t k = 0; k < kDirections; ++k) {
      const double free = rays.first_surface({at.p, direction(k)}) / h;
      is_whole = is_whole && free > 1;
      reach[k] = static_cast<float>(std::min(free, most));
    }
    KernelMoments m;
    for (std::size_t k = 0; k < kDirections; ++k) {
      const auto [ax, ay] = corner(k);
      const auto [bx, by] = corner((k + 1) % kDirections);
      add_edge(kShape, ax, ay, bx, by, m);
    }
    weight = m.one > 0 ? kernel_weights(m) : std::array<double, 3>{};
    if (is_whole) weight = {2 / kPi, 0, 0};
  }

  /// Of a leg that passes the plane at x [1/m2].
  double operator()(const Vec3& x) const {
    const Vec3 d = (x - centre) / h;
    const double px = dot(d, frame.t), py = dot(d, frame.b), q = px * px + py * py;
    if (q >= 1 || (!is_whole && !is_inside(px, py))) return 0;
    return kernel(kShape, q) * (weight[0] + weight[1] * px + weight[2] * py) / (h * h);
  }

 private:
  static double angle(std::size_t k) { return 2 * kPi * (static_cast<double>(k) + 0.5) / kDirections; }
  Vec3 direction(std::size_t k) const { return frame.t * std::cos(angle(k)) + frame.b * std::sin(angle(k)); }
  std::array<double, 2> corner(std::size_t k) const {
    return {double{reach[k]} * std::cos(angle(k)), double{reach[k]} * std::sin(angle(k))};
  }
  bool is_inside(double x, double y) const {
    double turn = std::atan2(y, x) / (2 * kPi) * kDirections - 0.5;
    if (turn < 0) turn += kDirections;
    const auto k = static_cast<std::size_t>(turn) % kDirections;
    const auto [ax, ay] = corner(k);
    const auto [bx, by] = corner((k + 1) % kDirections);
    return (bx - ax) * (y - ay) - (by - ay) * (x - ax) >= 0;
  }
};

/// Calls passed(disc, leg, place) where a leg passes a disc from the front.
template <class Passed>
void pass(const Discs& discs, std::span<const ReceivingPoint> points, std::span<const std::uint32_t> numbers,
          const CausticLeg& leg, double beyond, const Passed& passed) {
  const Vec3 from = leg.start(), d = leg.end() - from, way = d * (1 + beyond / std::max(beyond, length(d)));
  const Vec3 to = from + way;
  discs.along(from, to, [&](std::uint32_t disc, double share) {
    const std::uint32_t p = numbers[disc];
    if (dot(points[p].n, way) < 0) passed(p, from + way * share);
  });
}

Discs discs_of(std::span<const ReceivingPoint> points, std::span<const std::uint32_t> numbers,
               std::span<const double> radius) {
  std::vector<Disc> discs;
  for (const std::uint32_t p : numbers) discs.push_back({points[p].p, points[p].n, radius[p]});
  return Discs(discs);
}

/// h of each point; 0 where no leg passes.
std::vector<double> radii(std::span<const ReceivingPoint> points, std::span<const CausticLeg> legs,
                          std::size_t legs_of_point, double diameter) {
  const double largest = kLargest * diameter, beyond = kBeyond * diameter;
  std::vector<double> radius(points.size(), largest);
  std::vector<std::uint32_t> all(points.size());
  for (std::uint32_t p = 0; p < points.size(); ++p) all[p] = p;
  // Of each point, how many legs of a pilot pass within each radius.
  std::vector<std::array<std::atomic<unsigned>, kRadii>> passed(points.size());
  const std::size_t step = std::max<std::size_t>(1, legs.size() / kPilot), pilots = (legs.size() + step - 1) / step;
  {
    const Discs discs = discs_of(points, all, radius);
    parallel_for(pilots, 64, [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k)
        pass(discs, points, all, legs[(k * step + mix_bits(k) % step) % legs.size()], beyond,
             [&](std::uint32_t p, const Vec3& x) {
               const double r = length(x - points[p].p) / largest;
               const int smallest = r > 0 ? static_cast<int>(-2 * std::log2(r)) : kRadii - 1;
               passed[p][static_cast<std::size_t>(std::clamp(smallest, 0, kRadii - 1))].fetch_add(
                   1, std::memory_order_relaxed);
             });
    });
  }
  std::vector<std::uint32_t> unknown;
  for (std::uint32_t p = 0; p < points.size(); ++p) {
    unsigned within = 0;
    int k = kRadii - 1;
    for (; k >= 0; --k) {
      within += passed[p][static_cast<std::size_t>(k)].load(std::memory_order_relaxed);
      if (within >= kFewest) break;
    }
    if (within == 0) unknown.push_back(p);
    if (k < 0) continue;  // few: the largest
    const double r2 = std::pow(0.5, k) * largest * largest, density = static_cast<double>(within * step) / r2;
    radius[p] = std::min(largest, std::sqrt(static_cast<double>(legs_of_point) / density));
  }
  // Where the pilot found nothing, others may.
  std::vector<std::atomic<bool>> any(points.size());
  const Discs discs = discs_of(points, unknown, radius);
  parallel_for(unknown.empty() ? 0 : legs.size(), 256, [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k)
      pass(discs, points, unknown, legs[k], beyond,
           [&](std::uint32_t p, const Vec3&) { any[p].store(true, std::memory_order_relaxed); });
  });
  for (const std::uint32_t p : unknown)
    if (!any[p].load(std::memory_order_relaxed)) radius[p] = 0;
  return radius;
}

/// Makes what lights give sum to E, none of it below 0.
void fit(LightRow& row, const Spectrum& E) {
  Spectrum sum(0.0), share;
  for (RowEntry& entry : row)
    for (std::size_t c = 0; c < entry.weight.size(); ++c) {
      entry.weight[c] = std::max(0.0f, entry.weight[c]);
      sum.c[c] += double{entry.weight[c]};
    }
  for (int c = 0; c < kMaxChannels; ++c) share[c] = sum[c] > 0 ? E[c] / sum[c] : 0;
  for (RowEntry& entry : row) entry.scale(share);
}

}  // namespace

CausticIrradiance caustic_irradiance(const Problem& problem, std::span<const CausticLeg> legs,
                                     std::size_t legs_of_point, std::size_t count, const PointOf& point_of,
                                     bool with_rows) {
  CausticIrradiance found{Field(count, problem.patches.channels), std::vector<double>(count, 0.0), {}};
  if (with_rows) found.rows.resize(count);
  if (legs.empty() || count == 0) return found;
  std::vector<ReceivingPoint> points(count);
  for (std::size_t i = 0; i < count; ++i) points[i] = point_of(i);
  const std::vector<double> radius = radii(points, legs, legs_of_point, problem.rays.diameter());
  std::vector<std::uint32_t> lit;
  std::vector<std::uint32_t> number_of(count);
  for (std::uint32_t p = 0; p < count; ++p)
    if (radius[p] > 0) number_of[p] = static_cast<std::uint32_t>(lit.size()), lit.push_back(p);
  if (lit.empty()) return found;
  std::vector<std::unique_ptr<const Kernel>> kernels(lit.size());
  parallel_for(lit.size(), 64, [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k)
      kernels[k] = std::make_unique<const Kernel>(problem.rays, points[lit[k]], radius[lit[k]]);
  });
  const Discs discs = discs_of(points, lit, radius);
  struct Passing {
    std::uint32_t point, leg;
    Spectrum E;
  };
  const bool has_glass = problem.rays.has_glass();
  std::vector<std::atomic<char>> glass(has_glass ? legs.size() : 0);  // of a leg: 0 not known, 1 none, 2 some
  const auto leg_meets_glass = [&](std::size_t k) {
    if (glass[k].load(std::memory_order_relaxed) == 0) {
      const Spectrum passes = problem.rays.glass_transmittance(legs[k].start(), legs[k].end());
      glass[k].store(passes[0] == 1 && passes[1] == 1 && passes[2] == 1 ? 1 : 2, std::memory_order_relaxed);
    }
    return glass[k].load(std::memory_order_relaxed) == 2;
  };
  const std::size_t blocks = (legs.size() + kBlock - 1) / kBlock;
  std::size_t round = 2, begin = 0;
  while (begin < blocks) {
    std::vector<std::vector<Passing>> of_block(std::min(round, blocks - begin));
    parallel_for(of_block.size(), 1, [&](std::size_t from, std::size_t to) {
      for (std::size_t b = from; b < to; ++b)
        for (std::size_t k = (begin + b) * kBlock; k < std::min((begin + b + 1) * kBlock, legs.size()); ++k)
          pass(discs, points, lit, legs[k], kBeyond * problem.rays.diameter(), [&](std::uint32_t p, const Vec3& x) {
            const double w = (*kernels[number_of[p]])(x);
            if (w == 0) return;
            Spectrum E = legs[k].sent() * w;
            if (has_glass && leg_meets_glass(k)) E *= problem.rays.glass_transmittance(legs[k].start(), x);
            of_block[b].push_back({p, static_cast<std::uint32_t>(k), E});
          });
    });
    std::size_t passings = 0;
    for (const auto& block : of_block) {
      passings += block.size();
      for (const auto& [p, leg, E] : block) {
        found.E.add(p, E);
        found.variance[p] += luminous_mean(E) * luminous_mean(E);
        if (with_rows) add_to_row(found.rows[p], legs[leg].light, E);
      }
    }
    begin += of_block.size();
    round = std::clamp<std::size_t>(kAtOnce * of_block.size() / (passings + 1), 1, kRound);
  }
  // At edges a kernel takes off a little of what is far off.
  for (double& E : found.E.value) E = std::max(0.0, E);
  if (with_rows)
    for (std::size_t p = 0; p < count; ++p) fit(found.rows[p], found.E[p]);
  return found;
}

CausticIrradiance caustic_irradiance(const Problem& problem, std::size_t count, const PointOf& point_of,
                                     bool with_rows) {
  const Caustics& caustics = problem.lights.caustics;
  return caustic_irradiance(problem, caustics.legs, caustics.legs_of_point, count, point_of, with_rows);
}

}  // namespace clerestory
