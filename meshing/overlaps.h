#pragma once
// What is seen of a plane where several faces lie in it.

#include <optional>
#include <span>
#include <vector>

#include "meshing/stacked_faces.h"
#include "meshing/surface_complex.h"
#include "solver/model/box_tree.h"
#include "solver/model/material.h"

namespace clerestory {

/// Knows the faces of one plane group by place; refers to the complex.
///
/// Where faces cover each other, each side of the plane shows one of them, taken in this order:
///   glass, a diffuser or a mirror that wins by size owns both sides; else a face that acts on this side (its front, or
///   two-sided) before one whose black back is there; a front before a back; the material that covers less of the
///   plane, a source counting half, before one that covers more. Of faces that were read as lying over each other, if
///   only by a hair (stacked_faces.h), each side shows the outermost, and nothing opaque gives way to a sheet. So a
///   pane or a door is cut out of its wall on both sides, a wall stored twice with opposite normals shows either front,
///   and the order of the file does not matter.
class Covering {
 public:
  Covering(const FaceComplex& complex, const PlaneGroup& group, std::span<const Material> materials);

  struct Found {
    Sheet sheet;
    int faces = 0;  ///< that cover the place
  };
  /// What covers p, of which a disc of radius `reach` around p is known to be covered alike.
  std::optional<Found> at(const Point2& p, double reach) const;

 private:
  struct Piece {
    std::array<Point2, 3> corner;  ///< counter-clockwise around Plane::n
    bool faces_up;
    MaterialId material;
    SurfaceId surface;
    double rank;  ///< area that this material covers [1], halved for a source
    HeightAsRead height;
  };
  bool hides(const Piece& p, const Piece& q, bool above) const;
  const Piece* outermost(const std::vector<const Piece*>& covering, bool above) const;
  const Piece* winner(const std::vector<const Piece*>& covering, bool above, bool by_size_only) const;

  const FaceComplex& complex_;
  std::vector<Piece> pieces_;
  std::optional<BoxTree<StoredBoxes>> tree_;
  std::span<const Material> materials_;
};

}  // namespace clerestory
