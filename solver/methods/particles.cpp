#include "solver/methods/particles.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>
#include <vector>

#include "solver/model/parallel.h"
#include "solver/model/streams.h"
#include "solver/particles/emission.h"

namespace clerestory {
namespace {

constexpr std::size_t kBatches = 32;        // their standard deviation is known to 13 %
constexpr double kFewest = 1 << 15;         // particles
constexpr double kPilot = 64;               // particles for one of the pilot
constexpr std::uint32_t kBlock = 1 << 8;    // particles of a task
constexpr std::size_t kLandings = 1 << 18;  // that are kept at a time, or one a patch

/// Means of batches, and their spread.
class BatchSums {
 public:
  BatchSums(std::size_t count, int channels)
      : sum_(count, channels), squares_(count, channels), batch_(count, channels) {}

  void add(std::size_t i, const Spectrum& x) { batch_.add(i, x); }
  /// per: what the sums of a batch are divided by.
  void end_batch(double per) {
    ++batches_;
    for (std::size_t i = 0; i < batch_.value.size(); ++i) {
      const double mean = batch_.value[i] / per;
      sum_.value[i] += mean, squares_.value[i] += mean * mean;
    }
    std::ranges::fill(batch_.value, 0.0);
  }
  Field mean() const {
    Field mean = sum_;
    for (double& x : mean.value) x /= std::max(1.0, batches_);
    return mean;
  }
  /// One batch knows no spread: its value may be all wrong.
  Field std_error() const {
    Field error = sum_;
    for (std::size_t i = 0; i < error.value.size(); ++i) {
      const double m = sum_.value[i] / std::max(1.0, batches_);
      error.value[i] =
          batches_ < 2 ? m : std::sqrt(std::max(0.0, (squares_.value[i] / batches_ - m * m) / (batches_ - 1)));
    }
    return error;
  }

 private:
  double batches_ = 0;
  Field sum_, squares_, batch_;
};

/// Particles in rounds of about as many landings as are kept at a time, whatever the albedo.
class ParticleSource {
 public:
  ParticleSource(const Illumination& light, std::size_t landings)
      : light_(light), emission_(light), most_(static_cast<double>(landings)) {}

  double flux() const { return emission_.flux(); }
  /// The next particles of the sequence `key`, up to `count` of them; they are in ways() then. returns how many.
  std::uint32_t follow(std::uint64_t key, std::uint32_t first, std::uint32_t count, const Monitor& monitor) {
    count = std::min(count, round_);
    const std::uint32_t blocks = (count + kBlock - 1) / kBlock;
    ways_.assign(blocks, {});
    parallel_for(blocks, 1, [&](std::size_t from, std::size_t to) {
      for (std::size_t b = from; b < to; ++b) {
        const auto begin = static_cast<std::uint32_t>(b) * kBlock;
        ways_[b] = follow_particles(light_, emission_, key, first + begin, std::min(kBlock, count - begin), monitor);
      }
    });
    double landings = 1;
    for (const ParticleWays& w : ways_) landings += static_cast<double>(w.landings.size());
    const double fits = most_ * count / landings;
    round_ = static_cast<std::uint32_t>(std::clamp(fits, double{kBlock}, std::min(4.0 * count + kBlock, 1e8)));
    return count;
  }
  std::span<const ParticleWays> ways() const { return ways_; }

 private:
  const Illumination& light_;
  Emission emission_;
  double most_;
  std::uint32_t round_ = 4 * kBlock;
  std::vector<ParticleWays> ways_;
};

/// Radius of the kernel at each point. Noise squared falls as 1 / (landings h^2), bias squared grows as h^4: together
/// they are least where h is as landings^(-1/6). Landings are those of a patch of the room in the mean: where it is
/// darker the light varies more for what there is of it. An edge of the mesh is right for so many: measured in the
/// Cornell box and the office (tests/bench/README.md).
std::vector<double> radii(const PatchSet& patches, const VertexLightmap& map, std::span<const double> landings) {
  constexpr double kOfAnEdge = 11'000, kLeast = 0.5, kMost = 3;
  std::vector<double> factor(patches.room_count(), 0.0), count(factor.size(), 0.0);
  for (std::size_t i = 0; i < landings.size(); ++i)
    factor[patches.room_of(i)] += landings[i], ++count[patches.room_of(i)];
  for (std::size_t r = 0; r < factor.size(); ++r)
    factor[r] = std::clamp(std::pow(kOfAnEdge * count[r] / std::max(factor[r], 1.0), 1.0 / 6), kLeast, kMost);
  std::vector<double> radius = edge_lengths(patches, map);
  for (std::size_t p = 0; p < radius.size(); ++p) radius[p] *= factor[patches.room_of(map.patch_of_point[p])];
  return radius;
}

void raise(Field& x, std::size_t i, double least) {
  for (int c = 0; c < x.channels; ++c) x.at(i, c) = std::max(x.at(i, c), least);
}

}  // namespace

Solution trace_particles(const Illumination& light, const ParticleOptions& options, VertexLightmap* map,
                         const Monitor& monitor) {
  const PatchSet& patches = light.problem.patches;
  const std::size_t n = patches.patch_count(), points = map ? map->position.size() : 0;
  ParticleSource source(light, std::max(kLandings, n));
  const double wanted = std::max(kFewest, options.particles * static_cast<double>(n));
  const auto in_batch = static_cast<std::uint32_t>(std::min(std::ceil(wanted / kBatches), 1e9));

  BatchSums of_patches(n, patches.channels), of_points(points, patches.channels);

  Solution solution;
  solution.method = "particles";
  EnergyBalance energy;
  double followed = 0;        // that `energy` is of
  Monitor patient = monitor;  // the first round gets a little more time: patches need a value
  if (monitor.has_deadline()) patient.deadline += std::chrono::seconds(1);
  const auto kernels_of = [&](const VertexLightmap& points_of) {
    // A pilot tells how many landings there will be, and is thrown away: radii that knew their own would bias them.
    const auto pilot = static_cast<std::uint32_t>(wanted / kPilot);
    std::vector<double> on(n, 0.0);
    for (std::uint32_t done = 0; done < pilot && !patient.should_stop();) {
      done += source.follow(stream_key(options.seed, kParticles, kBatches), done, pilot - done, patient);
      for (const ParticleWays& w : source.ways()) {
        for (const Landing& landing : w.landings) on[landing.patch] += wanted / pilot;
        solution.rays += w.rays;
      }
    }
    std::vector<double> radius = radii(patches, points_of, on);
    for (double& h : radius) h *= options.radius;
    return SurfaceKernels(patches, points_of, radius, options.kernel);
  };
  LandingsByPatch landings;
  const SurfaceKernels kernels = map ? kernels_of(*map) : SurfaceKernels();
  for (std::size_t batch = 0; batch < kBatches && solution.stop == StopReason::converged; ++batch) {
    std::uint32_t done = 0;
    while (done < in_batch && solution.stop == StopReason::converged) {
      monitor.report("particles", (static_cast<double>(batch) + static_cast<double>(done) / in_batch) / kBatches);
      const Monitor& asked = followed == 0 ? patient : monitor;
      const std::uint32_t count =
          source.follow(stream_key(options.seed, kParticles, batch), done, in_batch - done, asked);
      if (asked.should_stop()) {
        solution.stop = why_stopped(monitor);
        break;
      }
      for (const ParticleWays& w : source.ways()) energy += w.energy, solution.rays += w.rays;
      landings.sort(source.ways(), n);
      parallel_for(n, 256, [&](std::size_t from, std::size_t to) {
        for (std::size_t i = from; i < to; ++i) {
          Spectrum flux(0.0);
          for (const Landing& landing : landings[i])
            flux += Spectrum(double{landing.flux[0]}, double{landing.flux[1]}, double{landing.flux[2]});
          of_patches.add(i, flux / patches.area[i]);
        }
      });
      parallel_for(points, 64, [&](std::size_t from, std::size_t to) {
        for (std::size_t p = from; p < to; ++p) of_points.add(p, kernels.irradiance(p, landings));
      });
      done += count, followed += count;
      if (monitor.should_stop()) solution.stop = why_stopped(monitor);
    }
    // Of a batch that was stopped only the first is used: there is no other.
    if (done == in_batch || (batch == 0 && done > 0)) {
      of_patches.end_batch(done), of_points.end_batch(done);
      solution.iterations += done;
    }
    if (batch == 0) monitor.say_result();
  }

  solution.E = of_patches.mean();
  solution.std_error = of_patches.std_error();
  // Batches that met nothing agree that there is nothing: no place is known better than to one particle.
  const double one = followed > 0 ? source.flux() / followed : 0;
  for (std::size_t i = 0; i < n; ++i) raise(solution.std_error, i, one / patches.area[i]);
  solution.B = Field(n, patches.channels);
  for (std::size_t i = 0; i < n; ++i) solution.B.set(i, patches.M[i] + patches.scattered(solution.E, i));
  if (followed > 0)
    solution.energy = {energy.emitted / followed, energy.absorbed / followed, energy.escaped / followed};
  if (map) {
    average_to_points(patches, solution.E, *map);
    map->std_error = of_points.std_error();
    for (std::size_t p = 0; p < points; ++p) raise(map->std_error, p, one * kernels.largest_weight(p));
    const Field E = of_points.mean();
    for (std::size_t p = 0; p < points; ++p) {
      if (!kernels.has_surface(p)) continue;
      // At edges a kernel takes off a little of what is far off.
      for (int c = 0; c < E.channels; ++c) map->E.at(p, c) = std::max(E.at(p, c), 0.0);
    }
  }
  return solution;
}

}  // namespace clerestory
