#include "solver/hierarchy/receiver_rays.h"

#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/sampling/unit_square.h"
#include "solver/visibility/shadow_rays.h"

namespace clerestory {
namespace {

constexpr std::uint32_t kPilotPairs = 16;  // one packet

}  // namespace

void send_bundle(const ReceiverArea& area, const Problem& problem, const BundleNet& net, std::uint64_t key,
                 Bundle& bundle) {
  const bool alone = area.members().size() == 1;
  const Frame frame(area.members()[0].normal);
  for (std::size_t k = 0; k < bundle.rays.size(); ++k) {
    auto u = net(k, key);
    const ReceiverArea::Member& from = area.pick(u[2]);
    bundle.from[k] = &from;
    bundle.rays[k] = {problem.rays.off_surface(point_on_triangle(from.corners, u[2], u[3]), from.normal),
                      cosine_direction(alone ? frame : Frame(from.normal), u[0], u[1])};
  }
  if (problem.rays.has_echoes()) bundle.echoes.resize(bundle.rays.size());
  problem.rays.first_hits(problem.patches, bundle.rays, bundle.hits, bundle.echoes);
}

BrightPair bright_pair(const ReceiverArea& area, const Illumination& light, std::uint32_t number, std::uint64_t key) {
  // Place and choice of the source matter most: they share one sequence, and are stratified against each other.
  const auto u = sobol4(number, key);
  auto v = sobol4(number, mix_bits(key));
  const ReceiverArea::Member& member = area.pick(v[1]);
  const Vec3 from = light.problem.rays.off_surface(point_on_triangle(member.corners, u[0], u[1]), member.normal);
  const LightSample s = light.sampler.sample(light.sampler.receiver(from, member.normal), u[2], u[3], v[0], true);
  return {from, s.density > 0 ? s.end : from, member.normal, s};
}

int pairs_worth_sending(const ReceiverArea& area, const Illumination& light, int wanted, std::uint64_t key) {
  if (!light.sampler.has_bright_patches() || wanted <= 0) return 0;
  if (light.sky.dark()) return wanted;
  const bool seen = any_visible(light.problem.rays, kPilotPairs, [&](std::uint32_t k, Vec3& from, Vec3& to) {
    const BrightPair pair = bright_pair(area, light, k, mix_bits(key + kBrightPairPilot));
    from = pair.from, to = pair.to;
    return pair.valid();
  });
  return seen ? wanted : 0;
}

}  // namespace clerestory
