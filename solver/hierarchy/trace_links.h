#pragma once
// Links by rays: a bundle from every receiver, and pairs with bright sources.

#include <cstdint>
#include <vector>

#include "solver/hierarchy/links.h"
#include "solver/illumination/direct.h"
#include "solver/illumination/illumination.h"
#include "solver/model/element_tree.h"
#include "solver/model/monitor.h"

namespace clerestory {

/// Where there would be more receivers, wider clusters receive together.
inline constexpr std::size_t kMostReceivers = 200'000;

struct LinkOptions {
  int bundle_rays = 256;
  int bright_rays = 128;        ///< pairs with bright sources
  double uniform = 0.01;        ///< hits are linked at the highest node whose B varies by less than this share of
                                ///< E_p; 0: at the leaf they met
  double cluster_diameter = 0;  ///< nodes of up to 32 leaves within this receive together [m]
  bool sky_views = true;        ///< keep what is seen of the sky; a scene without any has no use for it
  std::uint64_t seed = 1;
};

/// For each receiver: rays (receiver_rays.h) find what arrives, weighted by two estimators and made to sum to one
/// (arrivals.h), which is cut at the nodes of the tree into links, within uniform * E_p (cut_row.h).
///
/// light  made with what the bright sources send more than their surroundings; its problem is that of the leaves.
/// B      N x channels, radiosity known so far, or what it is above its ground light; empty: nothing is merged.
/// direct light that the links do not bring; sky through the openings it has looked at is not looked for again.
/// Cost   R + L rays for each receiver; 8 bytes a link and a ray that leaves.
Transport trace_links(const Illumination& light, const ElementTree& tree, const Field& B, const DirectLight& direct,
                      const LinkOptions& options, const Monitor& monitor = {});

struct BundleRay {
  Ray ray;
  Hit hit;
};
/// The rays that trace_links() with the same arguments sent from this receiver, once more.
std::vector<BundleRay> trace_bundle(const Illumination& light, const ElementTree& tree, const Receiver& receiver,
                                    const LinkOptions& options);

}  // namespace clerestory
