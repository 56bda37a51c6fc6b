#pragma once
// The meshed scene as arrays: T conforming triangles, and N patches, each one side of a triangle.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "solver/model/channels.h"
#include "solver/model/ids.h"
#include "solver/model/material.h"
#include "solver/model/vec.h"

namespace clerestory {

/// Front is the side from which the corners run counter-clockwise.
enum Side : std::uint8_t { kFront = 0, kBack = 1 };

/// Name of the room that all open air is.
inline constexpr const char* kOutdoors = "outdoors";
/// Of those that are too small to be told one by one.
inline constexpr const char* kSmallerSpaces = "smaller spaces";
/// Rooms that nobody gave a name are called so, with a number.
inline constexpr const char* kUnnamedRoom = "room ";

/// A node of the binary trees that part patches. The parted edge runs from corner `edge` to the next one; part 0 keeps
/// its start and gets the corners (start, middle, apex), part 1 its end: (middle, end, apex).
struct SplitNode {
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::uint32_t first_part = kNone;  ///< node of part 0, part 1 follows it; kNone: not parted
  std::uint32_t patch = kNone;       ///< PatchId, when it is not parted
  float at = 0.5f;                   ///< share of the edge before its middle, in (0, 1)
  std::uint8_t edge = 0;
  bool is_cut() const { return at != 0.5f; }  ///< where light asked for it, and not halved
};

/// Goes from a parted triangle to one of its parts: from shares of its corners at a place to those of the part's there.
/// Whether that is part 1.
inline bool go_to_part(float share_at, std::size_t edge, std::array<double, 3>& share) {
  constexpr std::array<std::size_t, 5> kCorner{0, 1, 2, 0, 1};
  const double start = share[edge], end = share[kCorner[edge + 1]], apex = share[kCorner[edge + 2]];
  if (share_at == 0.5f) {
    const bool second = end > start;
    share = second ? std::array{2 * start, end - start, apex} : std::array{start - end, 2 * end, apex};
    return second;
  }
  // The middle is (1 - at) start + at end.
  const double at = double{share_at}, rest = 1 - at;
  const bool second = end * rest > start * at;
  share = second ? std::array{start / rest, end - start * (at / rest), apex}
                 : std::array{start - end * (rest / at), end / at, apex};
  return second;
}

/// A triangle always blocks light (glass: passes its share; a mirror: sends it on); its sides take part in transport as
/// patches. All coordinates are relative to `origin`, so that float rays lose nothing in georeferenced models.
///
/// Patches may be finer than the triangles that rays meet: then triangle i carries patch i alone, on one of its sides,
/// and `splits` tells which part of a ray's triangle is which patch (solver/hierarchy/element_mesh.h).
struct PatchSet {
  Vec3 origin;       ///< of the local frame, in the scene's frame [m]
  int channels = 1;  ///< 1 or 3

  // T triangles on V vertices. Triangles that share an edge share its two vertices.
  std::vector<Vec3> vertices;                            ///< V, local frame [m]
  std::vector<std::array<VertexId, 3>> corners;          ///< T
  std::vector<std::array<MaterialId, 2>> side_material;  ///< T, by Side
  std::vector<std::array<SurfaceId, 2>> side_surface;    ///< T, by Side
  std::vector<std::array<PatchId, 2>> side_patch;  ///< by triangle of the rays and Side; invalid where that side takes
                                                   ///< no part; the root in `splits` when there are any
  std::vector<SplitNode> splits;  ///< the first are the patches before any was halved; empty: rays meet whole patches
  /// T by Side, or empty for none; bit k: something ends a little off this side, over the edge from corner k to the
  /// next (front order). Light may jump there, though the surface goes on smoothly.
  std::vector<std::array<std::uint8_t, 2>> outlines;
  std::vector<bool> joined;  ///< T, or empty for none: two faces lie here back to back, so the back is a front as well

  // N patches.
  std::vector<TriangleId> triangle;  ///< N
  std::vector<Side> side;            ///< N
  std::vector<double> area;          ///< N [m2]
  std::vector<Vec3> normal;          ///< N, unit, away from the surface on the patch's side
  Field rho;                         ///< N, reflectance [1]
  Field M;                           ///< N, exitance [W/m2]
  Field tau;                         ///< N, share that diffusers pass to their other side [1]; empty: there are none
  std::vector<std::uint8_t> level;   ///< N, halvings since the patch; empty: none was halved
  std::vector<std::uint32_t> space;  ///< N, patches that see each other, directly or over others, have one number;
                                     ///< empty: not known
  std::vector<std::uint32_t> room;   ///< N, by solver/spaces/rooms.h; empty: not known
  std::vector<bool> spot;  ///< N, lit by the sun or a luminaire, bright for the room around it; empty: not known

  /// A patch on the other side of a diffuser's patch, and the share of that patch's area which it covers.
  struct Behind {
    PatchId patch;
    double share;
  };
  std::vector<std::uint32_t> behind_begin;  ///< N + 1; empty like tau
  std::vector<Behind> behind;

  std::vector<Material> materials;    ///< by MaterialId
  std::vector<std::string> surfaces;  ///< by SurfaceId
  std::vector<std::string> rooms;     ///< names, by `room`

  std::size_t patch_count() const { return triangle.size(); }
  /// Where rooms are not known, all are one.
  std::uint32_t room_of(std::size_t patch) const { return room.empty() ? 0 : room[patch]; }
  std::size_t room_count() const { return std::max<std::size_t>(1, rooms.size()); }
  std::size_t triangle_count() const { return corners.size(); }
  MaterialId material(PatchId p) const { return side_material[triangle[p]][side[p]]; }
  SurfaceId surface(PatchId p) const { return side_surface[triangle[p]][side[p]]; }
  /// Of its front; sheets have the same on both sides.
  const Material& front_material(TriangleId t) const { return materials[side_material[t][kFront]]; }
  /// The patch that a ray meets in its triangle t (T counted before splits), at barycentric weights u, v of corners
  /// 1, 2.
  PatchId patch_at(TriangleId t, Side side, double u, double v) const;
  /// Whether something ends a little off the patch, over one of its edges.
  bool has_outline(PatchId p) const { return !outlines.empty() && outlines[triangle[p]][side[p]] != 0; }
  /// Corner positions of patch p, counter-clockwise seen from its side.
  std::array<Vec3, 3> corner_positions(PatchId p) const;
  double total_area() const;

  std::span<const Behind> patches_behind(std::size_t p) const {
    if (tau.value.empty()) return {};
    return std::span(behind).subspan(behind_begin[p], behind_begin[p + 1] - behind_begin[p]);
  }
  /// What leaves patch p of the light that arrives as E (N x channels) on both of its sides: rho E + tau E behind.
  Spectrum scattered(const Field& E, std::size_t p) const {
    Spectrum B = rho[p] * E[p];
    for (const Behind& other : patches_behind(p)) B += tau[p] * E[other.patch] * other.share;
    return B;
  }
  /// One way on for light that fell on patch p, chosen by pick in [0, 1) in proportion to the light that takes it: the
  /// side it leaves from (unit normal), and the share of it over the probability of the choice.
  struct Scattering {
    Vec3 normal;
    Spectrum share;
  };
  Scattering scatter(PatchId p, double pick) const;
  /// Whether that is a choice at all.
  bool scatters_through(PatchId p) const { return !tau.value.empty() && !tau[p].is_black(); }
  /// Share of the light that falls on patch p and is not absorbed [1].
  Spectrum albedo(std::size_t p) const { return tau.value.empty() ? rho[p] : rho[p] + tau[p]; }
};

/// The place of a patch's plane that x is nearest to. Rays in float hit it only nearly, and one bounce in ten thousand
/// would go on from behind it: at a reflectance of 0.999999 most ways of light.
inline Vec3 in_plane_of(const PatchSet& patches, PatchId p, const Vec3& x) {
  const Vec3& n = patches.normal[p];
  return x - n * dot(n, x - patches.vertices[patches.corners[patches.triangle[p]][0]]);
}

/// sum A x over the patches [W], luminous mean; x: N x channels, per area, such as M: what surfaces emit.
double total_flux(const PatchSet& patches, const Field& x);

/// (Re)builds the patch arrays from the triangles: one patch for each side with wanted[2 * t + side], in that order;
/// glass and mirrors have none, and a diffuser's sides go together. Area, normal, rho and M follow from the materials;
/// a material's total power is shared over the area of its emitting patches; the back of a one-sided material is black,
/// unless it is the front of a joined face.
void make_patches(PatchSet& patches, const std::vector<bool>& wanted);

}  // namespace clerestory
