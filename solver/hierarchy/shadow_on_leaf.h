#pragma once
// How the edge of a light's shadow runs through one leaf.

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "solver/hierarchy/element_mesh.h"
#include "solver/illumination/sharp_light.h"

namespace clerestory {

/// The least width of a penumbra on an edge of that length, as a share of it: 2 %, but no more than 5 mm.
inline double narrowest_penumbra(double length) { return std::min(0.02, 5e-3 / length); }

/// A leaf as a light sees it.
class LeafInLight {
 public:
  LeafInLight(const ElementMesh& mesh, std::uint32_t leaf)
      : x_(mesh.corner_positions(leaf)), n_(mesh.patches().normal[mesh[leaf].patch]) {}

  Vec3 centre() const { return (x_[0] + x_[1] + x_[2]) / 3; }
  const Vec3& normal() const { return n_; }
  const std::array<Vec3, 3>& corners() const { return x_; }
  double length_of(std::size_t k) const { return length(x_[(k + 1) % 3] - x_[k]); }
  /// A point a little inside of edge k, as points of the lightmap are: off what stands on it.
  Vec3 on_edge(std::size_t k, double t) const { return inside(x_[k] * (1 - t) + x_[(k + 1) % 3] * t); }
  Vec3 inside(const Vec3& p) const { return p + (centre() - p) * VertexLightmap::kWayToCentroid; }

 private:
  std::array<Vec3, 3> x_;
  Vec3 n_;
};

/// Where the light's centre comes or goes along the edges of a leaf: bit k of `lit`: corner k sees it; of the points
/// between corners bits 3 + kInner * edge ...
struct ShadowOutline {
  static constexpr int kInner = 4;  ///< points of an edge looked at between its corners

  std::uint16_t lit = 0;

  bool at(std::size_t edge, int i) const {
    if (i == 0) return lit >> edge & 1;
    if (i == kInner + 1) return lit >> ((edge + 1) % 3) & 1;
    return lit >> (3 + kInner * static_cast<int>(edge) + i - 1) & 1;
  }
  bool mixed() const { return lit != 0 && lit != (1u << (3 + 3 * kInner)) - 1; }
  int flips(std::size_t edge) const {
    int count = 0;
    for (int i = 0; i <= kInner; ++i) count += at(edge, i) != at(edge, i + 1);
    return count;
  }
};

ShadowOutline shadow_outline(const SharpLight& light, const LeafInLight& leaf_in_light);

/// How the light's shadow runs through a leaf: in by one edge and out by another, straight or bent; in some other way;
/// with a penumbra so wide that it is no edge.
enum class ShadowRun { none, straight, bent, crooked, wide };

ShadowRun shadow_run(const SharpLight& light, const LeafInLight& leaf_in_light, const ShadowOutline& outline);

enum class PenumbraEnd : std::size_t { dark, lit };  ///< of a penumbra: beyond it nothing of the light is seen, or all

/// The end of the penumbra on an edge of a leaf, where it has one; at least half the narrowest width from the centre.
std::optional<double> penumbra_end_on(PenumbraEnd end, const SharpLight& light, const LeafInLight& leaf_in_light,
                                      std::size_t edge, const ShadowOutline& outline);

}  // namespace clerestory
