#pragma once
// Patches halved where the light asks for it, without T-vertices.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/model/patch_set.h"
#include "solver/model/vertex_lightmap.h"

namespace clerestory {

/// A forest over the patches: an element is a patch or a half of an element, halved at its longest edge. Neighbours across
/// that edge are halved with it (first at their own longest edges, until it is theirs too), so the leaves conform on
/// every side of every surface; front and back of a sheet are halved apart. Angles stay above half of the patches'.
/// Source: Rivara, "Algorithms for refining triangular grids suitable for adaptive and multigrid techniques", 1984.
class ElementMesh {
 public:
  /// patches  not halved yet; both outlive the mesh.
  ElementMesh(const PatchSet& patches, const VertexLightmap& map);

  /// An element: leaf or halved. Elements 0 .. patch_count() - 1 are the patches; halves are appended in pairs.
  struct Element {
    std::array<std::uint32_t, 3> vertex;     ///< into vertices(), counter-clockwise from the lit side
    std::array<std::uint32_t, 3> point;      ///< into points()
    std::array<std::uint32_t, 3> neighbour;  ///< leaf across edge k (corner k to k + 1), VertexLightmap::kNone: none
    std::uint32_t patch;                     ///< it is part of
    std::uint32_t first_half = SplitNode::kNone;
    std::uint8_t edge = 0;   ///< corner where its longest edge starts
    std::uint8_t level = 0;  ///< halvings since the patch
    bool is_leaf() const { return first_half == SplitNode::kNone; }
  };
  std::size_t size() const { return elements_.size(); }
  const Element& operator[](std::size_t e) const { return elements_[e]; }
  const std::vector<Vec3>& vertices() const { return vertices_; }
  std::size_t point_count() const { return position_.size(); }
  const Vec3& point_position(std::size_t p) const { return position_[p]; }
  std::array<Vec3, 3> corners(std::size_t e) const;
  std::size_t leaf_count() const { return leaves_; }

  /// Halves each of the given elements that is still a leaf, and what conformity asks for.
  void split(std::span<const std::uint32_t> marked);

  /// Ends of the edge that each point beyond the lightmap's own stands in the middle of: [point - points of the map].
  const std::vector<std::array<std::uint32_t, 2>>& parents() const { return parents_; }

  /// The leaves as patches, in the order of the patches they are part of, each side's triangles its own; `splits` tells
  /// rays of the original triangles which leaf they meet.
  PatchSet leaf_patches() const;
  /// Elements by leaf patch, in the order of leaf_patches().
  std::vector<std::uint32_t> leaves() const;
  /// Lightmap of leaf_patches(): same points, new ones after the old. E is sized and zero.
  VertexLightmap leaf_lightmap() const;
  /// Where irradiance is gathered for the new points `first` and up; see VertexLightmap.
  // (samples of new points are kept in the mesh as they are made)

 private:
  std::uint32_t middle_of(std::uint32_t element, std::uint8_t edge);
  void halve(std::uint32_t element);
  const PatchSet& patches_;
  const VertexLightmap& map_;
  std::vector<Element> elements_;
  std::vector<Vec3> vertices_, position_;
  std::vector<std::array<std::uint32_t, 2>> parents_;
  std::size_t leaves_ = 0;
};

}  // namespace clerestory
