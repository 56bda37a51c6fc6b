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
  int bright_rays = 128;        ///< pairs with bright sources, a multiple of 16
  double uniform = 0.01;        ///< hits are linked at the highest node whose B varies by less than this share of
                                ///< E_p; 0: at the leaf they met
  double cluster_diameter = 0;  ///< nodes of up to 32 leaves within this receive together [m]
  std::uint64_t seed = 1;
};

/// Two estimators for the weight of p <- q, combined by the power heuristic (Veach & Guibas 1995): R cosine rays that
/// leave points all over p, and L pairs of a point of p with one of a bright source, chosen by light.sampler. A ray of
/// either kind that ends on a bright patch counts
///   w = c own / (own^2 + other^2),   c = cos / pi, own and other: R c and L density, or the other way round;
/// one that ends elsewhere w = 1 / R. The bright patches' weights so have the noise of pairs where these are better.
/// What they leave of all directions is shared by the rest of the bundle: patches, sky, glass. So a row sums to 1 less
/// what escapes or is lost, exactly.
///
/// Hits, sorted in the order of the tree, are cut at its nodes from the root: a node takes all under it when
///   (sum of w) * (standard deviation of B over its area) <= uniform * E_p
/// and |sum of w (B of the node - B of the leaf that was hit)|, added up over the nodes taken so far, stays below a
/// tenth of that: what is hidden of a node is darker than what is seen, and without the second condition a row loses 2
/// %.
///
/// light  made with what the bright sources send more than their surroundings; its problem is that of the leaves.
/// B      N x channels, radiosity known so far, or what it is above a level; empty: nothing is merged.
/// direct light that the links do not bring; sky through the openings it has looked at is not looked for again.
/// Cost   R + L rays for each receiver; 8 bytes a link.
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
