#include "meshing/overlaps.h"

#include <map>
#include <tuple>

namespace clerestory {
namespace {

double twice_area(const Point2& a, const Point2& b, const Point2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Distance from p to the nearest edge's line, positive inside of a counter-clockwise triangle.
double depth(const std::array<Point2, 3>& t, const Point2& p) {
  double least = Box::kHuge;
  for (int k = 0; k < 3; ++k) {
    const Point2 a = t[static_cast<std::size_t>(k)], b = t[static_cast<std::size_t>((k + 1) % 3)];
    least = std::min(least, twice_area(a, b, p) / std::hypot(b.x - a.x, b.y - a.y));
  }
  return least;
}

}  // namespace

Covering::Covering(const FaceComplex& complex, const PlaneGroup& group, std::span<const Material> materials)
    : complex_(complex), materials_(materials) {
  std::map<std::tuple<std::uint32_t, std::uint32_t, bool>, double> area;
  pieces_.reserve(group.faces.size());
  std::vector<Box> boxes;
  for (const std::uint32_t f : group.faces) {
    const Face& face = complex.faces[f];
    Piece piece{{}, true, face.material, face.surface, 0, height_as_read(complex, group.plane, face)};
    for (std::size_t k = 0; k < 3; ++k) piece.corner[k] = group.plane.flatten(complex.vertices[face.corner[k]]);
    double a = twice_area(piece.corner[0], piece.corner[1], piece.corner[2]) / 2;
    if (a < 0) {
      std::swap(piece.corner[1], piece.corner[2]);
      piece.faces_up = false;
      a = -a;
    }
    area[{face.material.value, face.surface.value, piece.faces_up}] += a;
    Box box;
    for (const Point2& p : piece.corner) box.add(Vec3{p.x, p.y, 0});
    boxes.push_back(box);
    pieces_.push_back(piece);
  }
  for (Piece& p : pieces_) {
    const Material& m = materials_[p.material];
    const bool preferred = m.emits() || m.is_sheet();
    p.rank = area[{p.material.value, p.surface.value, p.faces_up}] * (preferred ? 0.5 : 1);
  }
  if (pieces_.size() > 1) tree_.emplace(pieces_.size(), StoredBoxes{std::move(boxes)});
}

/// Whether p lies over q, seen from that side.
bool Covering::hides(const Piece& p, const Piece& q, bool above) const {
  const double gap = gap_between(complex_, q.height, p.height);
  return above ? gap > 0 : gap < 0;
}

/// The one that hides all that are hidden, if any are.
const Covering::Piece* Covering::outermost(const std::vector<const Piece*>& covering, bool above) const {
  return *std::ranges::max_element(covering, {}, [&](const Piece* p) {
    return above ? 2 * p->height.low - p->height.high : p->height.low - 2 * p->height.high;
  });
}

const Covering::Piece* Covering::winner(const std::vector<const Piece*>& covering, bool above,
                                        bool by_size_only) const {
  const Piece* best = nullptr;
  const auto key = [&](const Piece& p) {
    const Material& m = materials_[p.material];
    const bool front = p.faces_up == above;
    const bool acts = front || m.sides == 2;
    return by_size_only ? std::tuple(0, 0, p.rank) : std::tuple(acts ? 0 : 1, front ? 0 : 1, p.rank);
  };
  const Piece* outer = by_size_only ? nullptr : outermost(covering, above);
  for (const Piece* p : covering) {
    if (outer && hides(*outer, *p, above)) continue;
    if (!best || key(*p) < key(*best)) best = p;
  }
  return best;
}

std::optional<Covering::Found> Covering::at(const Point2& p, double reach) const {
  const double contact = complex_.allowed.contact;
  std::vector<const Piece*> covering;
  if (!tree_) {
    covering.push_back(&pieces_.front());
    if (depth(covering.front()->corner, p) < -contact) covering.clear();
  } else {
    // In a cell narrower than the tolerance a point may fall beside the faces that meant to cover it.
    for (const double slack : {0.0, reach < contact ? contact : 0.0}) {
      if (!covering.empty()) break;
      Box box;
      box.add(Vec3{p.x, p.y, 0});
      tree_->visit(box.grown(slack), [&](std::uint32_t k) {
        if (depth(pieces_[k].corner, p) >= -slack) covering.push_back(&pieces_[k]);
      });
    }
    // The tree's order is not the file's.
    std::sort(covering.begin(), covering.end());
  }
  if (covering.empty()) return std::nullopt;

  const Piece* best = winner(covering, true, true);
  Found found;
  found.faces = static_cast<int>(covering.size());
  const bool is_flush = std::ranges::none_of(covering, [&](const Piece* q) {
    return !materials_[q->material].is_sheet() && gap_between(complex_, best->height, q->height) != 0;
  });
  // A pane before a wall does not open it; a mirror or a diffuser on one hides it.
  const Material& material = materials_[best->material];
  if (material.is_sheet() && (is_flush || !material.lets_rays_pass()))
    covering.assign(1, best);
  else
    std::erase_if(covering, [&](const Piece* q) { return materials_[q->material].is_sheet(); });
  const Piece *above = winner(covering, true, false), *below = winner(covering, false, false);
  found.sheet = {above->material, below->material, above->surface, below->surface, false, false};
  found.sheet.flipped = !above->faces_up && !below->faces_up;
  found.sheet.joined = above->faces_up && !below->faces_up;
  return found;
}

}  // namespace clerestory
