#include "solver/methods/path_tracer.h"

#include <cmath>
#include <numbers>

#include "solver/sampling.h"

namespace clerestory {

Spectrum PathSum::std_error() const {
  if (count < 2) return Spectrum(0.0);
  Spectrum e;
  for (int k = 0; k < kMaxChannels; ++k) {
    const double m = sum[k] / count;
    e[k] = std::sqrt(std::max(0.0, (sum_of_squares[k] / count - m * m) / (count - 1)));
  }
  return e;
}

Spectrum trace_path(const Illumination& light, Vec3 p, Vec3 n, const std::array<double, 2>& u, RandomStream& random,
                    unsigned long long& rays) {
  const Problem& problem = light.problem;
  const PatchSet& patches = problem.patches;
  Spectrum E(0.0), throughput(1.0);
  for (bool first = true;; first = false) {
    if (!light.lamps.empty()) {
      const double pick = random.uniform(), a = random.uniform(), b = random.uniform();
      const LightSample s = light.lamps.sample(p, n, pick, a, b, false);
      if (!s.irradiance.is_black()) {
        double weight = 1;
        if (s.density > 0) {
          const double bundle = dot(n, normalized(s.end - p)) / std::numbers::pi;
          weight = s.density / (s.density + bundle);
        }
        E += throughput * s.irradiance * problem.rays.transmittance(p, s.end) * weight;
        ++rays;
      }
    }
    const double a = first ? u[0] : random.uniform(), b = first ? u[1] : random.uniform();
    const Vec3 d = cosine_direction(Frame(n), a, b);
    const Hit hit = problem.rays.first_hit(patches, {p, d});
    ++rays;
    throughput *= hit.transmittance;
    if (hit.escaped()) return E + throughput * light.sky(d) * std::numbers::pi;
    if (!hit.patch.valid()) return E;
    const Spectrum M = patches.M[hit.patch];
    if (!M.is_black()) {
      double weight = 1;
      if (light.lamps.is_explicit(hit.patch)) {
        const double bundle = dot(n, d) / std::numbers::pi;
        const double cos_patch = -dot(patches.normal[hit.patch], d);
        const double lamp = light.lamps.density(hit.patch, p, n, hit.distance, cos_patch, false);
        weight = bundle / (bundle + lamp);
      }
      E += throughput * M * weight;
    }
    throughput *= patches.rho[hit.patch];
    const double survival = std::min(1.0, throughput.max());
    if (!(random.uniform() < survival)) return E;
    throughput *= 1 / survival;
    p = p + d * static_cast<double>(hit.distance);
    n = patches.normal[hit.patch];
    p += n * problem.rays.lift();
  }
}

PathEstimate trace_paths_at_point(const Illumination& light, const Vec3& p, const Vec3& n, std::uint64_t key, int paths,
                                  unsigned long long& rays) {
  constexpr int kReplicates = 8;
  const int in_each = (paths + kReplicates - 1) / kReplicates;
  PathSum replicates;
  for (int r = 0; r < kReplicates; ++r) {
    const std::uint64_t replicate = stream_key(key, static_cast<std::uint64_t>(r));
    Spectrum sum(0.0);
    for (int k = 0; k < in_each; ++k) {
      const auto u = sobol4(static_cast<std::uint32_t>(k), replicate);
      RandomStream random(replicate, static_cast<std::uint64_t>(k));
      sum += trace_path(light, p, n, {u[0], u[1]}, random, rays);
    }
    replicates.add(sum / in_each);
  }
  return {replicates.mean(), replicates.std_error()};
}

}  // namespace clerestory
