#pragma once
// Rays of one receiver: a bundle that looks around, and pairs with bright patches.

#include <cstdint>
#include <vector>

#include "solver/hierarchy/receiver_area.h"
#include "solver/illumination/illumination.h"
#include "solver/sampling/bundle_net.h"
#include "solver/visibility/ray_scene.h"

namespace clerestory {

/// R rays that leave points all over the receiver, cosine-distributed about the normal of the member they leave from:
/// all together their directions have the density sum a_m max(0, n_m d) / pi. Its memory serves one receiver after
/// another.
struct Bundle {
  std::vector<Ray> rays;
  std::vector<Hit> hits;
  std::vector<Echo> echoes;  ///< by ray; empty without glass
  std::vector<const ReceiverArea::Member*> from;

  explicit Bundle(int count) : rays(static_cast<std::size_t>(count)), hits(rays.size()), from(rays.size()) {}
};

/// key  of the receiver: shifts the net.
void send_bundle(const ReceiverArea& area, const Problem& problem, const BundleNet& net, std::uint64_t key,
                 Bundle& bundle);

/// A point of the receiver with one of a bright patch.
struct BrightPair {
  Vec3 from, to, normal;  ///< both ends are lifted; normal at the receiver
  LightSample sample;     ///< density 0: there is no such pair

  bool valid() const { return sample.density > 0; }
};

/// The pair of this number in the sequence of `key`.
BrightPair bright_pair(const ReceiverArea& area, const Illumination& light, std::uint32_t number, std::uint64_t key);

/// How many of the pairs wanted are worth their rays: all or none. Under the sky bright patches mostly lie outdoors,
/// and most receivers do not see them: a few pairs tell. Without any that gets through, bright patches are left to the
/// bundle.
int pairs_worth_sending(const ReceiverArea& area, const Illumination& light, int wanted, std::uint64_t key);

}  // namespace clerestory
