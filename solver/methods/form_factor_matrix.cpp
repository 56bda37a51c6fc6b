#include "solver/methods/form_factor_matrix.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <numeric>

#include <unistd.h>

#include "solver/form_factors/sampled.h"
#include "solver/form_factors/shaft.h"
#include "solver/form_factors/triangle_to_triangle.h"
#include "solver/methods/echo_factors.h"
#include "solver/model/error.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/spaces/closure.h"

namespace clerestory {
namespace {

constexpr std::size_t kTile = 32;  // patches of a tile; by judgement
/// Relative error of an unblocked row sum: quadrature of far pairs, mostly far below.
constexpr double kQuadratureError = 3e-4;
constexpr int kRaysForClosure = 128;  // a patch: tells closed rows from those that lose 1 % or more
/// Standard error of one factor above which its visibility is sampled again by more rays.
constexpr double kPairError = 3e-5;
/// Standard error of a row's sum above which all its doubtful pairs are sampled again, by kSecondSamples rays. Patches
/// in a narrow gap need it, which have hundreds of half hidden partners. The true error is about half of this estimate,
/// which takes stratified samples for independent ones.
constexpr double kRowError = 3e-4;
constexpr int kSecondSamples = 256;
constexpr int kMostSamples = 32'768;  // of a pair: the standard error is a 200th of one sample's then

/// Patches of a compact cluster stand together in `order`, so that a tile of pairs shares one shaft.
void cluster(std::span<std::uint32_t> order, const std::vector<QuadratureTriangle>& triangles) {
  if (order.size() <= kTile) return;
  // Direction counts with position: the walls of a corner make a poor cluster.
  std::array<double, 6> low, high;
  low.fill(1e300), high.fill(-1e300);
  const auto key = [&](std::uint32_t i, std::size_t k) {
    return k < 3 ? triangles[i].centre[static_cast<int>(k)] : triangles[i].normal[static_cast<int>(k - 3)];
  };
  for (const std::uint32_t i : order)
    for (std::size_t k = 0; k < 6; ++k) low[k] = std::min(low[k], key(i, k)), high[k] = std::max(high[k], key(i, k));
  double extent = 0;
  for (std::size_t k = 0; k < 3; ++k) extent = std::max(extent, high[k] - low[k]);
  std::size_t axis = 0;
  double widest = -1;
  for (std::size_t k = 0; k < 6; ++k) {
    const double width = k < 3 ? high[k] - low[k] : 0.5 * (high[k] - low[k]) * extent;
    if (width > widest) widest = width, axis = k;
  }
  // Whole tiles to the left, so that only the last tile is short.
  const std::size_t half = (order.size() / 2 + kTile - 1) / kTile * kTile;
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(half);
  std::nth_element(order.begin(), middle, order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const double x = key(a, axis), y = key(b, axis);
    return x != y ? x < y : a < b;
  });
  cluster(order.first(half), triangles);
  cluster(order.subspan(half), triangles);
}

bool rises_over(const QuadratureTriangle& plane, const QuadratureTriangle& triangle) {
  const double on_plane = 1e-12 * (std::abs(plane.offset) + triangle.radius);
  return dot(plane.normal, triangle.corner[0]) - plane.offset > on_plane ||
         dot(plane.normal, triangle.corner[1]) - plane.offset > on_plane ||
         dot(plane.normal, triangle.corner[2]) - plane.offset > on_plane;
}

struct Builder {
  const RayScene& rays;
  std::uint64_t seed;
  std::vector<QuadratureTriangle> triangles;
  std::vector<std::uint32_t> order;
  std::vector<Box> tile_box;
  Blockers blockers;
  FormFactorMatrix& F;
  std::vector<float> row_variance;  ///< of row i from tile J: [i * tiles + J]
  std::size_t tiles = 0;
  std::vector<std::uint8_t> poor;  ///< rows to be sampled again
  std::atomic<std::size_t> unblocked{0}, sampled{0};
  std::atomic<unsigned long long> ray_count{0};

  Builder(const PatchSet& patches, const RayScene& scene, std::uint64_t seed_, FormFactorMatrix& matrix)
      : rays(scene), seed(seed_), blockers(patches), F(matrix) {
    const std::size_t n = patches.patch_count();
    triangles.reserve(n);
    for (std::size_t i = 0; i < n; ++i) triangles.emplace_back(patches.corner_positions(PatchId{i}));
    order.resize(n);
    std::iota(order.begin(), order.end(), 0u);
    cluster(order, triangles);
    tiles = (n + kTile - 1) / kTile;
    for (std::size_t t = 0; t < tiles; ++t) {
      Box box = Box::around(triangles[order[t * kTile]].corner);
      for (const std::uint32_t i : tile(t)) box.add(Box::around(triangles[i].corner));
      tile_box.push_back(box);
    }
    row_variance.assign(n * tiles, 0);
    poor.assign(n, 0);
  }

  std::span<const std::uint32_t> tile(std::size_t t) const {
    return std::span(order).subspan(t * kTile, std::min(kTile, order.size() - t * kTile));
  }

  /// All pairs of one patch in tile I and one in tile J. The second time: only those of a row that needs it.
  void tile_pair(std::size_t I, std::size_t J, bool second) {
    if (second && !holds_poor_row(I) && !holds_poor_row(J)) return;
    std::vector<const Blocker*> in_shaft;
    std::vector<const Screen*> screens;
    blockers.in_shaft(tile_box[I], tile_box[J], in_shaft);
    if (!in_shaft.empty()) blockers.screens_in_shaft(tile_box[I], tile_box[J], screens);
    std::array<double, kTile> variance_i{}, variance_j{};
    std::size_t unblocked_here = 0, sampled_here = 0;
    unsigned long long rays_here = 0;
    const auto tile_i = tile(I), tile_j = tile(J);
    for (std::size_t a = 0; a < tile_i.size(); ++a) {
      const std::uint32_t i = tile_i[a];
      const QuadratureTriangle& p = triangles[i];
      for (std::size_t b = I == J ? a + 1 : 0; b < tile_j.size(); ++b) {
        const std::uint32_t j = tile_j[b];
        const QuadratureTriangle& q = triangles[j];
        if (second && !poor[i] && !poor[j]) continue;
        if (!rises_over(p, q) || !rises_over(q, p)) continue;
        if (std::ranges::any_of(screens,
                                [&](const Screen* s) { return s->hides(p.corner, q.corner, blockers.touching()); }))
          continue;
        SampledVisibility visibility;
        const bool needs_rays = may_be_blocked(p, q, in_shaft);
        // The stream belongs to the pair, whichever way round the tiles list it.
        const std::uint64_t key = stream_key(stream_key(seed, kMatrixPairs), std::min(i, j), std::max(i, j));
        const SampledTriangle sampled_p{p.corner, p.normal}, sampled_q{q.corner, q.normal};
        (needs_rays ? sampled_here : unblocked_here) += 1;
        if (needs_rays) {
          visibility = second ? sample_visibility(sampled_p, sampled_q, rays, mix_bits(key + 1), kSecondSamples)
                              : sample_visibility_quick(sampled_p, sampled_q, rays, key);
          rays_here += static_cast<unsigned long long>(visibility.rays);
        } else if (second) {
          continue;
        }
        const double exchange = triangle_exchange(p, q);
        const double F_ij = exchange / p.area, F_ji = exchange / q.area;
        if (const int samples = samples_wanted(std::max(F_ij, F_ji) * visibility.std_error)) {
          visibility = sample_visibility(sampled_p, sampled_q, rays, mix_bits(key), samples);
          rays_here += static_cast<unsigned long long>(visibility.rays);
        }
        if (visibility.value == 0 && visibility.std_error == 0) continue;
        F.value[i * F.n + j] = static_cast<float>(std::min(1.0, F_ij * visibility.value));
        F.value[j * F.n + i] = static_cast<float>(std::min(1.0, F_ji * visibility.value));
        // Pairs whose samples all agree are off by little and either way: their bound would drown the measured spread.
        const bool resolved = visibility.value > 0 && visibility.value < 1;
        const double variance = resolved ? visibility.std_error * visibility.std_error : 0;
        variance_i[a] += F_ij * F_ij * variance;
        variance_j[b] += F_ji * F_ji * variance;
      }
    }
    const auto keep = [&](std::uint32_t i, std::size_t T, double variance) {
      if (!second || poor[i]) row_variance[i * tiles + T] = static_cast<float>(variance);
    };
    for (std::size_t a = 0; a < tile_i.size(); ++a) keep(tile_i[a], J, variance_i[a] + (I == J ? variance_j[a] : 0));
    if (I != J)
      for (std::size_t b = 0; b < tile_j.size(); ++b) keep(tile_j[b], I, variance_j[b]);
    ray_count += rays_here;
    if (!second) unblocked += unblocked_here, sampled += sampled_here;
  }

  bool holds_poor_row(std::size_t t) const {
    return std::ranges::any_of(tile(t), [&](std::uint32_t i) { return poor[i] != 0; });
  }

  double row_std_error(std::size_t i) const {
    double variance = 0;
    for (std::size_t t = 0; t < tiles; ++t) variance += double{row_variance[i * tiles + t]};
    return std::sqrt(variance);
  }

  /// Takes the tile pairs in parallel; false when the monitor stopped it. The first pass notes the rows it has filled.
  bool pass(bool second, const Monitor& monitor) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> work;
    work.reserve(tiles * (tiles + 1) / 2);
    for (std::size_t I = 0; I < tiles; ++I)
      for (std::size_t J = I; J < tiles; ++J)
        work.emplace_back(static_cast<std::uint32_t>(I), static_cast<std::uint32_t>(J));
    // In slices, so that progress and the wish to stop are seen between them.
    const std::size_t slice = std::max<std::size_t>(64, work.size() / 100);
    for (std::size_t done = 0; done < work.size(); done += slice) {
      if (monitor.should_stop()) {
        // Pairs are taken I by I, so rows of tiles before the next I have met all others.
        if (!second) note_filled(work[done].first);
        return false;
      }
      const double share = static_cast<double>(done) / static_cast<double>(work.size());
      monitor.report("form factors", second ? 0.85 + 0.15 * share : 0.85 * share);
      parallel_for(std::min(slice, work.size() - done), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = done + begin; k < done + end; ++k) tile_pair(work[k].first, work[k].second, second);
      });
    }
    if (!second) note_filled(tiles);
    return true;
  }

  /// Rows of the tiles before this one are filled.
  void note_filled(std::size_t end) {
    for (std::size_t t = 0; t < end; ++t)
      for (const std::uint32_t i : tile(t)) F.row_filled[i] = true;
  }

  /// Fills the matrix; false when the monitor stopped it.
  bool fill(const Monitor& monitor) {
    if (!pass(false, monitor)) return false;
    for (std::size_t i = 0; i < F.n; ++i) poor[i] = row_std_error(i) > kRowError;
    return pass(true, monitor);
  }

  /// Samples that bring a factor from this standard error, found with about 64, down to kPairError; 0: it is below.
  static int samples_wanted(double std_error) {
    if (std_error <= kPairError) return 0;
    const double wanted = 64 * std::pow(std_error / kPairError, 1.6);  // stratified samples converge like n^-0.6
    return std::min(kMostSamples, 256 * static_cast<int>(1 + wanted / 256));
  }

  bool may_be_blocked(const QuadratureTriangle& p, const QuadratureTriangle& q,
                      const std::vector<const Blocker*>& in_shaft) const {
    if (in_shaft.empty()) return false;
    const PairShaft shaft(p.corner, p.normal, q.corner, q.normal, blockers.touching());
    return std::ranges::any_of(in_shaft, [&](const Blocker* blocker) { return shaft.reached_by(*blocker); });
  }
};

/// sum_j F_ij x_j
double row_product(std::span<const float> row, std::span<const double> x) {
  double sum = 0;
  for (std::size_t j = 0; j < row.size(); ++j) sum += double{row[j]} * x[j];
  return sum;
}

/// y = (D_s + D F D) x over closed rows, where D F D is the scaled matrix and D_s its row sums.
struct ScaledMatrix {
  const FormFactorMatrix& F;
  std::vector<double> d, sum;

  void apply(const std::vector<double>& x, std::vector<double>& y) const {
    std::vector<double> dx(F.n);
    for (std::size_t j = 0; j < F.n; ++j) dx[j] = F.closed[j] ? d[j] * x[j] : 0;
    parallel_for(F.n, 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        y[i] = F.closed[i] ? sum[i] * x[i] + d[i] * row_product(F.row(i), dx) : 0;
    });
  }
  void update_sums() {
    parallel_for(F.n, 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) sum[i] = d[i] * row_product(F.row(i), d);
    });
  }
};

/// Scales F_ij <- d_i F_ij d_j until closed rows sum to 1: Newton's method for d. Its equation (D_s + D F D) e = sum -
/// 1, d <- d (1 - e), is symmetric in the inner product weighted by area and its eigenvalues lie in 0..2, so that a few
/// conjugate gradient steps solve it; plain Sinkhorn rounds stall where two patches see little but each other.
void close_rows(FormFactorMatrix& F, const std::vector<double>& area) {
  constexpr int kNewtonSteps = 4, kGradientSteps = 25;
  constexpr double kEnough = 1e-7;  // rounding to float leaves that much
  ScaledMatrix G{F, std::vector<double>(F.n, 1.0), std::vector<double>(F.n, 1.0)};
  const auto inner = [&](const std::vector<double>& a, const std::vector<double>& b) {
    double product = 0;
    for (std::size_t i = 0; i < F.n; ++i) product += area[i] * a[i] * b[i];
    return product;
  };
  for (int step = 0; step < kNewtonSteps; ++step) {
    G.update_sums();
    std::vector<double> residual(F.n, 0.0), e(F.n, 0.0), image(F.n, 0.0);
    double worst = 0;
    for (std::size_t i = 0; i < F.n; ++i) {
      if (F.closed[i]) residual[i] = G.sum[i] - 1;
      worst = std::max(worst, std::abs(residual[i]));
    }
    if (worst < kEnough) break;
    std::vector<double> direction = residual;
    double size = inner(residual, residual);
    const double enough = 1e-8 * size;
    for (int k = 0; k < kGradientSteps && size > enough; ++k) {
      G.apply(direction, image);
      const double curvature = inner(direction, image);
      if (!(curvature > 0)) break;
      const double along = size / curvature;
      for (std::size_t i = 0; i < F.n; ++i) e[i] += along * direction[i], residual[i] -= along * image[i];
      const double before = size;
      size = inner(residual, residual);
      for (std::size_t i = 0; i < F.n; ++i) direction[i] = residual[i] + size / before * direction[i];
    }
    // A row that could only be closed by a large change is not trusted with it.
    for (std::size_t i = 0; i < F.n; ++i) G.d[i] *= 1 - std::clamp(e[i], -0.1, 0.1);
  }
  const std::vector<double>& d = G.d;
  parallel_for(F.n, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t j = 0; j < F.n; ++j) {
        float& f = F.value[i * F.n + j];
        f = static_cast<float>(std::min(1.0, d[i] * double{f} * d[j]));
      }
  });
}

std::vector<double> row_sums(const FormFactorMatrix& F) {
  std::vector<double> sum(F.n);
  const std::vector<double> ones(F.n, 1.0);
  parallel_for(F.n, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) sum[i] = row_product(F.row(i), ones);
  });
  return sum;
}

/// Adds what glass turns back and lobes send on. Such rows sum to more than 1, by as much as lobes bring; of what
/// leaves the scene rays tell, and rows know their noise.
void add_lobes(FormFactorMatrix& F, const PatchSet& patches, const RayScene& rays, std::uint64_t seed,
               const Monitor& monitor) {
  const std::vector<double> before = F.row_sum;
  add_echoes(F, patches, rays, seed, monitor);
  F.row_sum = row_sums(F);
  const Lights dark;
  const Closure closure = measure_closure({patches, rays, dark}, kRaysForClosure, seed);
  F.rays += closure.rays;
  for (std::size_t i = 0; i < F.n; ++i) {
    const double more = std::max(0.0, F.row_sum[i] - before[i]);
    if (more > 0) F.closed[i] = false;
    F.row_error[i] += std::sqrt(more * (1 + more) / kEchoRays);
    F.escapes[i] = luminous_mean(closure.escapes[i]);
  }
}

/// Physical memory of the machine [bytes].
std::size_t physical_memory() {
  const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGE_SIZE);
  return pages > 0 && page > 0 ? static_cast<std::size_t>(pages) * static_cast<std::size_t>(page) : 0;
}

std::string format(const char* pattern, auto... values) {
  char line[256];
  std::snprintf(line, sizeof line, pattern, values...);
  return line;
}

}  // namespace

std::size_t form_factor_bytes(std::size_t n) {
  const std::size_t tiles = (n + kTile - 1) / kTile;
  return n * n * sizeof(float) + n * (sizeof(QuadratureTriangle) + tiles * sizeof(float) + 64);
}

void require_matrix_fits(std::size_t patches, const FormFactorOptions& options) {
  const std::size_t allowed = options.memory_limit > 0 ? options.memory_limit : physical_memory() / 10 * 6;
  const std::size_t needed = form_factor_bytes(patches);
  if (needed <= allowed || allowed == 0) return;
  constexpr double kMiB = 1024.0 * 1024.0;
  throw InputError(
      format("the full form-factor matrix of %zu patches needs %.0f MiB, more than the %.0f MiB allowed "
             "(60 %% of this machine's memory unless set); use a larger --max-element for fewer patches, "
             "or --method progressive, which needs no matrix.",
             patches, static_cast<double>(needed) / kMiB, static_cast<double>(allowed) / kMiB));
}

FormFactorMatrix form_factor_matrix(const PatchSet& patches, const RayScene& rays, const FormFactorOptions& options,
                                    const Monitor& monitor) {
  const std::size_t n = patches.patch_count();
  require_matrix_fits(n, options);
  FormFactorMatrix F;
  F.n = n;
  F.value.assign(n * n, 0.0f);
  F.row_error.assign(n, 0.0);
  F.closed.assign(n, false);
  F.row_filled.assign(n, false);
  F.escapes.assign(n, 1.0);
  if (n == 0) return F;

  {
    Builder builder(patches, rays, options.seed, F);
    F.complete = builder.fill(monitor);
    F.pairs_unblocked = builder.unblocked, F.pairs_sampled = builder.sampled, F.rays = builder.ray_count;
    for (std::size_t i = 0; i < n; ++i) F.row_error[i] = builder.row_std_error(i) + kQuadratureError;
  }
  // What lobes send on comes on top of rows that are whole without it.
  F.has_gloss = rays.has_gloss();
  if (F.complete && !F.has_gloss) add_echoes(F, patches, rays, options.seed, monitor);
  F.raw_row_sum = row_sums(F);
  F.row_sum = F.raw_row_sum;
  if (!F.complete) return F;

  const Lights dark;
  const RayScene matt = rays.without_gloss();
  const Closure closure = measure_closure({patches, matt, dark}, kRaysForClosure, options.seed);
  F.rays += closure.rays;
  for (std::size_t i = 0; i < n; ++i) {
    bool all_arrives = true;
    for (int k = 0; k < closure.arrives.channels; ++k) all_arrives &= closure.arrives.at(i, k) > 1 - 1e-9;
    const double lost = 1 - luminous_mean(closure.arrives[i]), escaped = luminous_mean(closure.escapes[i]);
    if (lost > 0) F.escapes[i] = std::clamp(escaped / lost, 0.0, 1.0);
    F.closed[i] = all_arrives && std::abs(F.raw_row_sum[i] - 1) <= 6 * F.row_error[i];
  }
  if (options.close_rows) {
    close_rows(F, patches.area);
    F.row_sum = row_sums(F);
  }
  if (F.has_gloss) add_lobes(F, patches, rays, options.seed, monitor);
  monitor.report("form factors", 1);
  return F;
}

std::vector<std::string> FormFactorMatrix::log() const {
  double worst = 0, square = 0;
  std::size_t closed_rows = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!closed[i]) continue;
    ++closed_rows;
    worst = std::max(worst, std::abs(raw_row_sum[i] - 1));
    square += (raw_row_sum[i] - 1) * (raw_row_sum[i] - 1);
  }
  const double rms = closed_rows ? std::sqrt(square / static_cast<double>(closed_rows)) : 0;
  return {format("form factors: %zu patches, %zu unblocked pairs, %zu sampled pairs, %llu rays", n, pairs_unblocked,
                 pairs_sampled, rays),
          format("form factors: %zu of %zu rows closed; their raw sums are off 1 by %.2g rms, %.2g at most",
                 closed_rows, n, rms, worst)};
}

}  // namespace clerestory
