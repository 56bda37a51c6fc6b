#include "solver/form_factors/sampled.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>

#include "solver/model/random_stream.h"
#include "solver/model/streams.h"

namespace clerestory {
namespace {

constexpr std::size_t kLanes = 16;         // of a packet
constexpr std::size_t kQuickSamples = 64;  // of a pair at first: four packets
constexpr std::size_t kSets = 16;          // replicates that give the standard error

/// Sixteen points of the four-dimensional unit cube.
struct Cube16 {
  std::array<float, kLanes> u[4];
};

/// A store of stratified patterns. A pair takes one and turns it by a random shift, which keeps the estimate unbiased
/// and costs four numbers instead of 64 scrambled Sobol points.
constexpr std::size_t kPatterns = 32;
using Pattern = std::array<Cube16, kQuickSamples / kLanes>;

const std::array<Pattern, kPatterns>& patterns() {
  static const auto store = [] {
    auto made = std::make_unique<std::array<Pattern, kPatterns>>();
    for (std::size_t p = 0; p < kPatterns; ++p)
      for (std::size_t k = 0; k < kQuickSamples; ++k) {
        const auto u = sobol4(static_cast<std::uint32_t>(k), stream_key(kVisibilityPattern, p));
        for (std::size_t dim = 0; dim < 4; ++dim)
          (*made)[p][k / kLanes].u[dim][k % kLanes] = static_cast<float>(u[dim]);
      }
    return made;
  }();
  return *store;
}

struct Vec3f {
  float x, y, z;
};
Vec3f to_float(const Vec3& a) { return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)}; }

/// A triangle relative to the pair's origin, in float: corner, two edges, normal.
struct LocalTriangle {
  Vec3f corner, edge1, edge2, normal;
  LocalTriangle(const SampledTriangle& t, const Vec3& origin)
      : corner(to_float(t.corner[0] - origin)),
        edge1(to_float(t.corner[1] - t.corner[0])),
        edge2(to_float(t.corner[2] - t.corner[0])),
        normal(to_float(t.normal)) {}
};

/// Traces point pairs by sixteen and keeps each one's kernel and share.
class PairSampler {
 public:
  PairSampler(const SampledTriangle& p, const SampledTriangle& q, const RayScene& rays)
      : origin_(p.corner[0]),
        p_(p, origin_),
        q_(q, origin_),
        fine_p_(p),
        fine_q_(q),
        rays_(rays),
        lift_(static_cast<float>(rays.lift())) {}

  /// Kernel of each point pair, 0 where one does not face the other.
  std::array<float, kLanes> kernel;
  /// Share that arrives of each.
  std::array<float, kLanes> share;

  void trace(const Cube16& cube, const std::array<float, 4>& shift) {
    const Vec3f o = to_float(origin_);
    for (std::size_t k = 0; k < kLanes; ++k) {
      const auto [xa, xb] = barycentric(cube.u[0][k] + shift[0], cube.u[1][k] + shift[1]);
      const auto [ya, yb] = barycentric(cube.u[2][k] + shift[2], cube.u[3][k] + shift[3]);
      const Vec3f x = at(p_, xa, xb), y = at(q_, ya, yb);
      const Vec3f d{y.x - x.x, y.y - x.y, y.z - x.z};
      const float r2 = d.x * d.x + d.y * d.y + d.z * d.z;
      const float over_p = p_.normal.x * d.x + p_.normal.y * d.y + p_.normal.z * d.z;
      const float over_q = -(q_.normal.x * d.x + q_.normal.y * d.y + q_.normal.z * d.z);
      // Halving the exponent range: r4 of far pairs in small units would leave float.
      kernel[k] = std::max(over_p, 0.0f) / r2 * (std::max(over_q, 0.0f) / r2);
      segments_.from_x[k] = o.x + (x.x + lift_ * p_.normal.x);
      segments_.from_y[k] = o.y + (x.y + lift_ * p_.normal.y);
      segments_.from_z[k] = o.z + (x.z + lift_ * p_.normal.z);
      segments_.to_x[k] = o.x + (y.x + lift_ * q_.normal.x);
      segments_.to_y[k] = o.y + (y.y + lift_ * q_.normal.y);
      segments_.to_z[k] = o.z + (y.z + lift_ * q_.normal.z);
    }
    unsigned active = 0;
    for (std::size_t k = 0; k < kLanes; ++k) active |= (kernel[k] > 0 ? 1u : 0u) << k;
    if (rays_.has_tight_places()) place_finely(cube, shift);
    const unsigned visible = active ? rays_.visible16(segments_, static_cast<std::uint16_t>(active)) : 0u;
    for (std::size_t k = 0; k < kLanes; ++k) share[k] = (visible >> k) & 1 ? 1.0f : 0.0f;
    rays_cast += std::popcount(active);
    if (rays_.has_glass()) pass_glass();
  }
  int rays_cast = 0;

 private:
  /// The low-distortion map of the unit square to a triangle (sampling.h), of coordinates in 0..2 taken modulo 1.
  static std::array<float, 2> barycentric(float u, float v) {
    u = u >= 1 ? u - 1 : u;
    v = v >= 1 ? v - 1 : v;
    const float low = 0.5f * std::min(u, v), high = std::max(u, v) - low;
    return v > u ? std::array{low, high} : std::array{high, low};
  }
  static Vec3f at(const LocalTriangle& t, float a, float b) {
    return {t.corner.x + a * t.edge1.x + b * t.edge2.x, t.corner.y + a * t.edge1.y + b * t.edge2.y,
            t.corner.z + a * t.edge1.z + b * t.edge2.z};
  }
  /// The same ends in double, lifted as far as there is room.
  void place_finely(const Cube16& cube, const std::array<float, 4>& shift) {
    const auto place = [&](const SampledTriangle& t, const std::array<float, 2>& weight) {
      const double a{weight[0]}, b{weight[1]};
      return rays_.off_surface(t.corner[0] * (1 - a - b) + t.corner[1] * a + t.corner[2] * b, t.normal);
    };
    for (std::size_t k = 0; k < kLanes; ++k) {
      segments_.from[k] = place(fine_p_, barycentric(cube.u[0][k] + shift[0], cube.u[1][k] + shift[1]));
      segments_.to[k] = place(fine_q_, barycentric(cube.u[2][k] + shift[2], cube.u[3][k] + shift[3]));
    }
  }
  void pass_glass() {
    unsigned seen = 0;
    for (unsigned k = 0; k < kLanes; ++k) seen |= (share[k] != 0 ? 1u : 0u) << k;
    for (unsigned met = rays_.meets_glass(segments_, static_cast<std::uint16_t>(seen)); met; met &= met - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(met));
      Vec3 from{segments_.from_x[k], segments_.from_y[k], segments_.from_z[k]};
      Vec3 to{segments_.to_x[k], segments_.to_y[k], segments_.to_z[k]};
      if (rays_.has_tight_places()) from = segments_.from[k], to = segments_.to[k];
      const Spectrum glass = rays_.glass_transmittance(from, to);
      share[k] = static_cast<float>((glass[0] + glass[1] + glass[2]) / 3);
    }
  }

  Vec3 origin_;
  LocalTriangle p_, q_;
  const SampledTriangle &fine_p_, &fine_q_;
  const RayScene& rays_;
  float lift_;
  SegmentPacket segments_;
};

std::array<float, 4> random_shift(RandomStream& random) {
  std::array<float, 4> shift;
  for (float& s : shift) s = static_cast<float>(random.bits() >> 40) * 0x1p-24f;
  return shift;
}

/// Standard error when all samples agree: the expected share that disagrees, by Laplace's rule of succession.
double unseen_share(int samples) { return 1.0 / (samples + 2); }

}  // namespace

SampledVisibility sample_visibility_quick(const SampledTriangle& p, const SampledTriangle& q, const RayScene& rays,
                                          std::uint64_t key) {
  RandomStream random(key);
  const Pattern& pattern = patterns()[random.bits() % kPatterns];
  const auto shift = random_shift(random);
  PairSampler sampler(p, q, rays);
  double weight = 0, passed = 0, weight2 = 0, weight2_share = 0, weight2_share2 = 0;
  float least = 1, most = 0;
  int samples = 0;
  for (const Cube16& cube : pattern) {
    sampler.trace(cube, shift);
    for (std::size_t k = 0; k < kLanes; ++k) {
      const double w = sampler.kernel[k], v = sampler.share[k];
      if (!(w > 0)) continue;  // nor a NaN: two points on one spot of an edge
      ++samples;
      least = std::min(least, sampler.share[k]), most = std::max(most, sampler.share[k]);
      weight += w, passed += w * v;
      weight2 += w * w, weight2_share += w * w * v, weight2_share2 += w * w * v * v;
    }
  }
  if (weight <= 0) return {0, 0, sampler.rays_cast};
  const double V = passed / weight;
  const double spread2 = std::max(0.0, weight2_share2 - 2 * V * weight2_share + V * V * weight2);
  const double std_error = least == most ? unseen_share(samples) : std::sqrt(spread2) / weight;
  return {V, std_error, sampler.rays_cast};
}

SampledVisibility sample_visibility(const SampledTriangle& p, const SampledTriangle& q, const RayScene& rays,
                                    std::uint64_t key, int samples) {
  const std::size_t packets = std::max<std::size_t>(1, static_cast<std::size_t>(samples) / (kSets * kLanes));
  PairSampler sampler(p, q, rays);
  std::array<double, kSets> weight{}, passed{};
  int counted = 0;
  float least = 1, most = 0;
  for (std::size_t set = 0; set < kSets; ++set) {
    const std::uint64_t set_key = stream_key(key, set);
    for (std::size_t packet = 0; packet < packets; ++packet) {
      Cube16 cube;
      for (std::size_t k = 0; k < kLanes; ++k) {
        const auto u = sobol4(static_cast<std::uint32_t>(packet * kLanes + k), set_key);
        for (std::size_t dim = 0; dim < 4; ++dim) cube.u[dim][k] = static_cast<float>(u[dim]);
      }
      sampler.trace(cube, {0, 0, 0, 0});
      for (std::size_t k = 0; k < kLanes; ++k) {
        if (!(sampler.kernel[k] > 0)) continue;
        ++counted;
        least = std::min(least, sampler.share[k]), most = std::max(most, sampler.share[k]);
        weight[set] += sampler.kernel[k], passed[set] += double{sampler.kernel[k]} * sampler.share[k];
      }
    }
  }
  double all_weight = 0, all_passed = 0;
  for (std::size_t set = 0; set < kSets; ++set) all_weight += weight[set], all_passed += passed[set];
  if (all_weight <= 0) return {0, 0, sampler.rays_cast};
  const double V = all_passed / all_weight;
  double spread2 = 0;  // of the sets' contributions to the ratio
  for (std::size_t set = 0; set < kSets; ++set) spread2 += std::pow(passed[set] - V * weight[set], 2);
  const double measured = std::sqrt(spread2 * kSets / (kSets - 1)) / all_weight;
  return {V, least == most ? unseen_share(counted) : measured, sampler.rays_cast};
}

}  // namespace clerestory
