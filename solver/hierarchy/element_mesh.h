#pragma once
// Patches halved where the light asks for it, without T-vertices.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/model/patch_set.h"
#include "solver/model/vertex_lightmap.h"

namespace clerestory {

/// A forest over the patches: an element is a patch or a half of an element, halved at its longest edge. Neighbours
/// across that edge are halved with it (first at their own longest edges, until it is theirs too), so the leaves
/// conform on every side of every surface; front and back of a sheet are halved apart. Angles stay above half of the
/// patches'. Source: Rivara, "Algorithms for refining triangular grids suitable for adaptive and multigrid techniques",
/// 1984.
class ElementMesh {
 public:
  /// patches  not halved yet; they outlive the mesh. map: their lightmap, of which E is not used.
  ElementMesh(const PatchSet& patches, VertexLightmap map);

  /// A leaf or a halved one. Elements 0 .. patch_count() - 1 are the patches; halves are appended in pairs.
  struct Element {
    std::array<std::uint32_t, 3> vertex;  ///< geometry, counter-clockwise from the lit side
    std::array<std::uint32_t, 3> point;   ///< of the lightmap: shared only where the surface is smooth
    /// Of a leaf: the leaf across edge k, from corner k to the next; VertexLightmap::kNone where there is none.
    std::array<std::uint32_t, 3> neighbour;
    std::uint32_t patch;                          ///< it is part of
    std::uint32_t first_half = SplitNode::kNone;  ///< the other half follows it
    std::uint8_t edge = 0;                        ///< corner where its longest edge starts
    std::uint8_t level = 0;                       ///< halvings since the patch
    bool is_leaf() const { return first_half == SplitNode::kNone; }
  };
  std::size_t size() const { return elements_.size(); }
  std::size_t leaf_count() const { return leaf_count_; }
  const Element& operator[](std::size_t e) const { return elements_[e]; }
  std::array<Vec3, 3> corner_positions(std::size_t e) const;
  /// Length of edge k of element e [m].
  double edge_length(std::size_t e, std::size_t k) const;
  const PatchSet& patches() const { return patches_; }

  /// Halves each of the given elements that is still a leaf, and what conformity asks for.
  void split(std::span<const std::uint32_t> marked);

  /// All points: those of the lightmap, then middles in the order they were made, with their places for samples.
  const VertexLightmap& points() const { return points_; }
  /// Points at the ends of the edge in whose middle point p stands; p is not one of the lightmap's own.
  const std::array<std::uint32_t, 2>& ends(std::size_t p) const { return ends_[p - first_middle_]; }

  /// Elements that are leaves, patch by patch: element of leaf patch i.
  std::vector<std::uint32_t> leaves() const;
  /// Leaves that element e is now; they follow each other in leaves().
  std::size_t leaves_under(std::uint32_t e) const;
  /// The leaves as patches in that order, each on a triangle of its own; `splits` tells rays which leaf they meet.
  PatchSet leaf_patches() const;
  /// Lightmap of leaf_patches(), made of the mesh's own points; E is sized P x channels and zero.
  VertexLightmap leaf_lightmap() &&;

 private:
  void find_longest_edge(Element& e) const;
  std::size_t edge_towards(std::uint32_t element, std::uint32_t from, std::uint32_t to) const;
  void halve_with_neighbour(std::uint32_t element);
  void halve(std::uint32_t element, std::uint32_t vertex, std::uint32_t point);
  std::uint32_t add_point(std::uint32_t element, std::uint32_t other, const Vec3& middle);

  const PatchSet& patches_;
  std::vector<Element> elements_;
  std::vector<Vec3> vertices_;
  VertexLightmap points_;  ///< position and samples only
  std::size_t first_middle_ = 0, leaf_count_ = 0;
  std::vector<std::array<std::uint32_t, 2>> ends_;
};

}  // namespace clerestory
