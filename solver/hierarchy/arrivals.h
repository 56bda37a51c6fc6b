#pragma once
// What arrives at one receiver: found by a bundle and by pairs, weighted, and made to sum to one.

#include <array>
#include <cstdint>
#include <vector>

#include "solver/hierarchy/receiver_area.h"
#include "solver/hierarchy/receiver_rays.h"
#include "solver/hierarchy/slit_lines.h"
#include "solver/hierarchy/sphere_parts.h"
#include "solver/illumination/direct.h"
#include "solver/illumination/illumination.h"
#include "solver/model/element_tree.h"

namespace clerestory {

/// Light on its way into a receiver.
struct Arrival {
  std::uint32_t node;  ///< leaf of the tree
  float weight;        ///< w: E += w B [1]
  std::uint16_t part;  ///< of the sphere; 0 for surfaces
  bool bright;         ///< of a bright patch, which both estimators may find
};

/// What one member looks at; shares as Transport keeps them.
struct MemberView {
  float arrives = 0;  ///< share of what it sends that reaches leaves [1]
  float escapes = 0;  ///< that leaves the scene [1]
};

/// Bright patches in a receiver's view [1].
struct BrightShares {
  double arrives = 0;  ///< what comes from them, by both estimators
  double seen = 0;     ///< the same before glass takes its share
  double hits = 0;     ///< share of the bundle that ended on them
};

/// All that was found for one receiver; its memory serves one after another.
struct Arrivals {
  std::vector<Arrival> list;
  std::array<MemberView, kMostMembers> view;  ///< by member
  PartShares shares;                          ///< of a receiver that hands down
  BrightShares bright;
  std::vector<SkyView> views;            ///< of the receiver
  std::vector<SharedView> shared_views;  ///< of one that hands down
  float view_weight = 0;                 ///< of each view [1]
  double E_sky = 0;  ///< luminous mean, over the receiver's area; where links are merged by it [W/m2]
};

/// What all receivers look into. direct: light that links do not bring; sky through the openings it has looked at is
/// not looked for again.
struct Surroundings {
  const Illumination& light;
  const ElementTree& tree;
  const DirectLight& direct;
  const SlitLines& slits;
  bool keeps_sky_views;
  bool sums_sky;  ///< whether Arrivals::E_sky is wanted
};

/// Two estimators for the weight of p <- q, combined by the power heuristic (Veach & Guibas 1995): R cosine rays that
/// leave points all over p, and L pairs of a point of p with one of a bright source, chosen by light.sampler. A ray of
/// either kind that ends on a bright patch counts
///   w = c own / (own^2 + other^2),   c = cos / pi, own and other: R c and L density, or the other way round;
/// one that ends elsewhere w = 1 / R. The bright patches' weights so have the noise of pairs where these are better.
/// What they leave of all directions is shared by the rest of the bundle: patches, sky, glass. So a row sums to 1 less
/// what escapes or is lost, exactly. What surfaces send through slits comes by the lines of those instead, and rays
/// that find it do not count.
///
/// bundle  sent from this area, R rays.
/// pairs   L; 0: bright patches are left to the bundle.
/// key     of the receiver.
void find_arrivals(const ReceiverArea& area, const Bundle& bundle, const Surroundings& around, int pairs,
                   std::uint64_t key, Arrivals& out);

}  // namespace clerestory
