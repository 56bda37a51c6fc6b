#pragma once
// Patches halved or cut where the light asks for it, without T-vertices.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "solver/model/patch_set.h"
#include "solver/model/vertex_lightmap.h"

namespace clerestory {

/// A forest over the patches: an element is a patch or a part of an element, halved at its longest edge. Neighbours
/// across that edge are halved with it (first at their own longest edges, until it is theirs too), so the leaves
/// conform on every side of every surface; front and back of a sheet are halved apart. Angles stay above half of the
/// patches'. Source: Rivara, "Algorithms for refining triangular grids suitable for adaptive and multigrid techniques",
/// 1984.
///
/// The forest knows what was parted where, the leaves' half-edges (OpenMesh) know corners and neighbours.
class ElementMesh {
 public:
  /// patches  not halved yet; they outlive the mesh. map: their lightmap, of which E is not used.
  ElementMesh(const PatchSet& patches, VertexLightmap map);
  ~ElementMesh();
  ElementMesh(ElementMesh&&) noexcept;

  /// A leaf or a parted one. Elements 0 .. patch_count() - 1 are the patches; parts are appended in pairs.
  struct Element {
    double area = 0;          ///< [m2]
    std::uint32_t patch = 0;  ///< it is part of
    std::uint32_t first = 0;  ///< of a parted one: its first part, the other follows it; of a leaf: its face
    float at = 0;             ///< of a parted one: share of the edge where it is parted
    std::uint8_t edge = 0;    ///< corner where the parted edge starts; of a leaf: its longest edge
    std::uint8_t level = 0;   ///< partings since the patch
    bool parted = false;
    bool penumbra = false;  ///< lies across the edge of a shadow, with corners on both of its sides
    bool is_leaf() const { return !parted; }
  };
  std::size_t size() const { return elements_.size(); }
  std::size_t leaf_count() const { return leaf_count_; }
  const Element& operator[](std::size_t e) const { return elements_[e]; }
  const PatchSet& patches() const { return patches_; }

  using Corners = std::array<std::uint32_t, 3>;
  /// Vertices of element e, counter-clockwise from the lit side.
  Corners vertices(std::uint32_t e) const;
  /// Points of the lightmap at its corners: shared only where the surface is smooth.
  Corners points_of(std::uint32_t e) const;
  std::array<Vec3, 3> corner_positions(std::uint32_t e) const;
  /// Of a leaf: the leaf across edge k, from corner k to the next; VertexLightmap::kNone where there is none.
  Corners neighbours(std::uint32_t leaf) const;
  /// Length of a leaf's longest edge [m].
  double longest_edge(std::uint32_t leaf) const;

  /// Halves each of the given elements that is still a leaf, and what conformity asks for.
  void split(std::span<const std::uint32_t> marked);

  /// Parts a leaf at edge k, from corner k to the next, and the leaf across it: at the share `at` of the edge's length,
  /// in (0, 1) and rounded to 2^-20 of it.
  void cut(std::uint32_t leaf, std::size_t k, double at);
  void mark_penumbra(std::uint32_t leaf) { elements_[leaf].penumbra = true; }

  /// All points: those of the lightmap, then middles in the order they were made, with their places for samples.
  const VertexLightmap& points() const { return points_; }
  /// Points at the ends of the edge on which point p was made; p is not one of the lightmap's own.
  const std::array<std::uint32_t, 2>& ends(std::size_t p) const { return ends_[p - first_middle_]; }

  /// Elements that are leaves, patch by patch: element of leaf patch i.
  std::vector<std::uint32_t> leaves() const;
  /// Leaves that element e is now; they follow each other in leaves().
  std::size_t leaves_under(std::uint32_t e) const;
  /// The leaves as patches in that order, each on a triangle of its own; `splits` tells rays which leaf they meet.
  PatchSet leaf_patches() const;
  /// Lightmap of leaf_patches(), made of the mesh's own points; E is sized P x channels and zero.
  VertexLightmap leaf_lightmap() &&;

  /// Whether OpenMesh's own checker finds nothing wrong with the half-edges; for tests.
  bool is_sound() const;

 private:
  struct HalfEdges;
  struct Parting;

  void describe(Element& leaf, std::uint32_t number, int corner0);
  void part_with_neighbour(std::uint32_t element, std::size_t edge, float at);
  bool is_outline(const Parting& here, const Parting& there) const;
  std::uint32_t add_point(const Parting& here, const Parting* other, double way, const Vec3& place);

  const PatchSet& patches_;
  std::vector<Element> elements_;
  std::vector<Vec3> vertices_;
  std::unique_ptr<HalfEdges> half_edges_;
  VertexLightmap points_;  ///< position and samples only
  std::size_t first_middle_ = 0, leaf_count_ = 0;
  std::vector<std::array<std::uint32_t, 2>> ends_;
};

}  // namespace clerestory
