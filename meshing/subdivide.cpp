#include "meshing/subdivide.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <queue>

#include "meshing/cells.h"
#include "meshing/divided_lines.h"
#include "solver/model/parallel.h"
#include "solver/model/triangle_size.h"

namespace clerestory {
namespace {

constexpr double kFinest = 0.2;               ///< angles are bettered down to this share of `longest`
constexpr double kStrip = 1.0 / 32;           ///< of the finest edge: strips narrower than that stay in one piece
constexpr double kRadiusToEdge = 1.18;        ///< circumradius / shortest edge = 1 / (2 sin 25 degrees)
constexpr std::uint32_t kInner = 0x80000000;  ///< ids from here on are a region's own, until the end
constexpr int kRounds = 24;

struct Halving {
  Ends line;
  std::uint32_t middle;
};

/// Where two planes meet in a wedge lower than the tolerance, both may hold the same needle: the first plane keeps it.
void keep_each_once(std::vector<MeshTriangle>& triangles) {
  std::vector<std::pair<std::array<std::uint32_t, 3>, std::size_t>> keys(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    keys[t] = {triangles[t].corner, t};
    std::sort(keys[t].first.begin(), keys[t].first.end());
  }
  std::sort(keys.begin(), keys.end());
  std::vector<bool> repeats(triangles.size());
  for (std::size_t k = 1; k < keys.size(); ++k) repeats[keys[k].second] = keys[k].first == keys[k - 1].first;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (!repeats[t]) triangles[kept++] = triangles[t];
  triangles.resize(kept);
}

/// What a finished plane leaves behind; corners from kInner on count `inner`, its points in the plane.
struct Shelf {
  std::vector<MeshTriangle> triangles;
  std::vector<Point2> inner;
  std::size_t cells = 0, overlapping = 0;  ///< of all regions when they were first drawn
};

struct Shape {
  double longest, shortest, radius;
  int longest_edge;  ///< opposite to this corner
};

Shape shape_of(const std::array<Point2, 3>& p) {
  Shape s{0, Box::kHuge, 0, 0};
  double product = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point2 &a = p[(i + 1) % 3], &b = p[(i + 2) % 3];
    const double l = std::hypot(b.x - a.x, b.y - a.y);
    if (l > s.longest) {
      s.longest = l;
      s.longest_edge = static_cast<int>(i);
    }
    s.shortest = std::min(s.shortest, l);
    product *= l;
  }
  const double twice_area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x);
  s.radius = twice_area > 0 ? product / (2 * twice_area) : Box::kHuge;
  return s;
}
bool is_too_long(const Shape& s, double longest) { return s.longest > longest * (1 + 1e-9); }
bool is_bad(const Shape& s, double longest) {
  return is_too_long(s, longest) || (s.radius > kRadiusToEdge * s.shortest && s.radius > kFinest * longest);
}

/// A face alone in its plane that is fine as it is, as most of a finely modelled scene are, needs no triangulation.
bool keep_lone_face(const FaceComplex& complex, const PlaneGroup& group, std::span<const Ends> lines,
                    const std::vector<std::uint32_t>& points, double longest, Shelf& shelf) {
  if (group.faces.size() != 1 || lines.size() != 3 || !points.empty()) return false;
  const Face& face = complex.faces[group.faces[0]];
  const auto& c = face.corner;
  std::array<Point2, 3> p;
  for (std::size_t k = 0; k < 3; ++k) {
    if (std::find(lines.begin(), lines.end(), ends_of(c[k], c[(k + 1) % 3])) == lines.end()) return false;
    p[k] = group.plane.flatten(complex.vertices[c[k]]);
  }
  if (is_bad(shape_of(p), longest)) return false;
  shelf.triangles.push_back({c, {face.material, face.material, face.surface, face.surface, false, false}});
  ++shelf.cells;
  return true;
}

/// One plane under refinement.
class RegionMesh {
 public:
  RegionMesh(const FaceComplex& complex, const PlaneGroup& group, std::span<const Material> materials,
             std::span<const Ends> lines, const std::vector<std::uint32_t>& points, double longest)
      : plane_(group.plane), longest_(longest), finest_(kFinest * longest) {
    handle_ = draw(cdt_, plane_, complex.vertices, lines, points);
    Cells cells = mark_sheets(cdt_, Covering(complex, group, materials));
    sheets_ = std::move(cells.sheets);
    cells_ = cells.count;
    overlapping_ = cells.overlapping;
  }

  /// Inserts vertices until no triangle is bad but those that wait for the lines it returns, sorted, to be halved.
  std::vector<Ends> refine(bool may_ask) {
    asked_.clear();
    may_ask_ = may_ask;
    for (const auto f : cdt_.finite_face_handles()) consider(f);
    while (!bad_.empty()) {
      const Bad bad = bad_.top();
      bad_.pop();
      Cdt::Face_handle f;
      if (cdt_.is_face(bad.corner[0], bad.corner[1], bad.corner[2], f)) better(f);
    }
    std::sort(asked_.begin(), asked_.end());
    asked_.erase(std::unique(asked_.begin(), asked_.end()), asked_.end());
    return asked_;
  }

  void halve(const Halving& h, const Vec3& middle) {
    const auto a = handle_.find(h.line[0]), b = handle_.find(h.line[1]);
    Cdt::Face_handle f;
    int i = 0;
    if (a == handle_.end() || b == handle_.end() || !cdt_.is_edge(a->second, b->second, f, i)) return;
    // Going counter-clockwise around the new vertex, what lay left of from -> to follows the half towards `to`.
    const Vertex from = f->vertex(cdt_.ccw(i)), to = f->vertex(cdt_.cw(i));
    const int left = f->info().mark, right = f->neighbor(i)->info().mark;
    const Point2 p = plane_.flatten(middle);
    const Vertex v = cdt_.insert({p.x, p.y}, Cdt::EDGE, f, i);
    v->info().id = h.middle;
    handle_[h.middle] = v;
    // All faces that changed are around v.
    auto face = cdt_.incident_faces(v);
    while (face->vertex(cdt_.ccw(face->index(v))) != to) ++face;
    const auto first = face;
    int mark = left;
    do {
      if (face->vertex(cdt_.ccw(face->index(v))) == from) mark = right;
      face->info().mark = mark;
    } while (++face != first);
  }

  std::size_t cell_count() const { return cells_; }
  std::size_t overlapping_count() const { return overlapping_; }
  void collect(Shelf& shelf) const {
    shelf.inner.insert(shelf.inner.end(), inner_.begin(), inner_.end());
    for (const auto f : cdt_.finite_face_handles()) {
      if (f->info().mark < 0) continue;
      MeshTriangle t{{}, sheets_[static_cast<std::size_t>(f->info().mark)]};
      for (int k = 0; k < 3; ++k) t.corner[static_cast<std::size_t>(k)] = f->vertex(k)->info().id;
      if (t.sheet.flipped) {
        std::swap(t.corner[1], t.corner[2]);
        std::swap(t.sheet.material_above, t.sheet.material_below);
        std::swap(t.sheet.surface_above, t.sheet.surface_below);
      }
      shelf.triangles.push_back(t);
    }
  }

 private:
  using Vertex = Cdt::Vertex_handle;
  struct Bad {
    double radius;
    std::array<std::uint32_t, 3> ids;
    std::array<Vertex, 3> corner;
    bool operator<(const Bad& b) const { return radius != b.radius ? radius < b.radius : ids > b.ids; }
  };
  static double distance(const CdtKernel::Point_2& a, const CdtKernel::Point_2& b) {
    return std::hypot(b.x() - a.x(), b.y() - a.y());
  }
  static Shape shape_of(Cdt::Face_handle f) {
    std::array<Point2, 3> p;
    for (int i = 0; i < 3; ++i) p[static_cast<std::size_t>(i)] = {f->vertex(i)->point().x(), f->vertex(i)->point().y()};
    return clerestory::shape_of(p);
  }
  bool is_too_long(const Shape& s) const { return clerestory::is_too_long(s, longest_); }
  bool is_bad(const Shape& s) const { return clerestory::is_bad(s, longest_); }

  void consider(Cdt::Face_handle f) {
    if (f->info().mark < 0) return;
    const Shape s = shape_of(f);
    if (!is_bad(s)) return;
    Bad bad{s.radius, {}, {}};
    for (int k = 0; k < 3; ++k) {
      bad.corner[static_cast<std::size_t>(k)] = f->vertex(k);
      bad.ids[static_cast<std::size_t>(k)] = f->vertex(k)->info().id;
    }
    std::sort(bad.ids.begin(), bad.ids.end());
    bad_.push(bad);
  }

  /// Asks for the line opposite to corner i of f to be halved; false when it is too short for that.
  bool ask(Cdt::Face_handle f, int i, double shortest_half) {
    if (!may_ask_) return false;
    const auto a = f->vertex(cdt_.cw(i)), b = f->vertex(cdt_.ccw(i));
    if (distance(a->point(), b->point()) < 2 * shortest_half) return false;
    asked_.push_back(ends_of(a->info().id, b->info().id));
    return true;
  }

  /// Whether p is so near to the line opposite to corner i of f that no halving of it gives well-shaped triangles
  /// there.
  bool lies_in_strip(const CdtKernel::Point_2& p, Cdt::Face_handle f, int i) const {
    const auto &a = f->vertex(cdt_.ccw(i))->point(), &b = f->vertex(cdt_.cw(i))->point();
    const double twice_area = (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
    return std::abs(twice_area) < kStrip * finest_ * distance(a, b);
  }

  void better(Cdt::Face_handle f) {
    const Shape s = shape_of(f);
    const bool too_long = is_too_long(s);
    if (insert_circumcentre(f, s, too_long)) return;
    if (!too_long) return;
    // Nothing else is left: halve the longest edge.
    if (cdt_.is_constrained({f, s.longest_edge})) {
      ask(f, s.longest_edge, 0);
      return;
    }
    const auto &a = f->vertex(cdt_.cw(s.longest_edge))->point(), &b = f->vertex(cdt_.ccw(s.longest_edge))->point();
    insert({(a.x() + b.x()) / 2, (a.y() + b.y()) / 2}, f);
  }

  /// True when done with f for now: a vertex was inserted, or a line that is in the way was asked to be halved.
  bool insert_circumcentre(Cdt::Face_handle f, const Shape& s, bool too_long) {
    if (!(s.radius < 1e3 * s.longest)) return blocked_beyond_reason(f, s);
    const CdtKernel::Point_2 c =
        CGAL::circumcenter(f->vertex(0)->point(), f->vertex(1)->point(), f->vertex(2)->point());
    // Walk from inside of f to c; a line on the way is encroached by c.
    const auto &p = f->vertex(0)->point(), &q = f->vertex(1)->point(), &r = f->vertex(2)->point();
    const CdtKernel::Point_2 from((p.x() + q.x() + r.x()) / 3, (p.y() + q.y() + r.y()) / 3);
    Cdt::Face_handle at = f;
    for (int entered = -1, steps = 0;; ++steps) {
      if (steps > 10'000) return false;
      int leave = -1;
      for (int i = 0; i < 3 && leave < 0; ++i) {
        if (i == entered) continue;
        const auto &a = at->vertex(cdt_.ccw(i))->point(), &b = at->vertex(cdt_.cw(i))->point();
        if (CGAL::orientation(a, b, c) != CGAL::RIGHT_TURN) continue;
        if (CGAL::orientation(from, c, a) != CGAL::LEFT_TURN && CGAL::orientation(from, c, b) != CGAL::RIGHT_TURN)
          leave = i;
      }
      if (leave < 0) break;
      if (cdt_.is_constrained({at, leave}))
        return (too_long || !lies_in_strip(at->vertex(leave)->point(), at, leave)) && ask(at, leave, finest_ / 2);
      const auto next = at->neighbor(leave);
      if (cdt_.is_infinite(next)) return false;
      entered = next->index(at);
      at = next;
    }
    if (at->info().mark != f->info().mark) return false;  // rounding led past a line's end
    std::vector<Cdt::Edge> rim;
    cdt_.get_boundary_of_conflicts(c, std::back_inserter(rim), at);
    bool asked = false, crowded = false;
    for (const auto& [g, i] : rim) {
      if (!cdt_.is_constrained({g, i})) continue;
      const auto &a = g->vertex(cdt_.ccw(i))->point(), &b = g->vertex(cdt_.cw(i))->point();
      if ((a.x() - c.x()) * (b.x() - c.x()) + (a.y() - c.y()) * (b.y() - c.y()) >= 0) continue;
      crowded = true;
      asked |= (too_long || !lies_in_strip(c, g, i)) && ask(g, i, finest_ / 2);
    }
    if (asked) return true;
    if (crowded && !too_long) return false;
    return insert(c, at);
  }
  /// f is next to flat: only halving a line of its can help.
  bool blocked_beyond_reason(Cdt::Face_handle f, const Shape& s) {
    return is_too_long(s) && cdt_.is_constrained({f, s.longest_edge}) && ask(f, s.longest_edge, finest_ / 2);
  }

  bool insert(const CdtKernel::Point_2& p, Cdt::Face_handle near) {
    const int mark = near->info().mark;
    Cdt::Locate_type type;
    int i = 0;
    const auto f = cdt_.locate(p, type, i, near);
    if (type == Cdt::VERTEX || type == Cdt::OUTSIDE_CONVEX_HULL || type == Cdt::OUTSIDE_AFFINE_HULL) return false;
    if (type == Cdt::EDGE && cdt_.is_constrained({f, i})) return ask(f, i, finest_ / 2);
    if (f->info().mark != mark) return false;
    const auto v = cdt_.insert(p, type, f, i);
    v->info().id = kInner + static_cast<std::uint32_t>(inner_.size());
    inner_.push_back({p.x(), p.y()});
    // All faces that changed are around v, and no line parts them.
    auto face = cdt_.incident_faces(v);
    const auto first = face;
    do face->info().mark = mark;
    while (++face != first);
    do consider(face);
    while (++face != first);
    return true;
  }

  Plane plane_;
  double longest_, finest_;
  Cdt cdt_;
  std::unordered_map<std::uint32_t, Vertex> handle_;
  std::vector<Sheet> sheets_;
  std::size_t cells_ = 0, overlapping_ = 0;
  std::vector<Point2> inner_;
  std::priority_queue<Bad> bad_;
  std::vector<Ends> asked_;
  bool may_ask_ = true;
};

}  // namespace

double estimate_triangles(const FaceComplex& complex, const std::vector<PlanarDomain>& domains, double area,
                          double longest) {
  // Lines that are shorter than the longest edge add their own triangles.
  double pieces = 0;
  for (const PlanarDomain& d : domains)
    for (const Ends& l : d.lines) {
      const double len = length(complex.vertices[l[1]] - complex.vertices[l[0]]);
      pieces += std::ceil(len / (kLineShare * longest));
    }
  return area / (kMeanTriangle * longest * longest) + pieces;
}

/// The edges of a region's triangle along which an outline runs.
class OutlineEdges {
 public:
  OutlineEdges(const PlanarDomain& domain, const DividedLines& lines) : lines_(lines) {
    for (std::size_t k = 0; k < domain.outline.size(); ++k)
      if (domain.outline[k] != kNoOutline)
        sides_.push_back({ends_of(domain.lines[k][0], domain.lines[k][1]), domain.outline[k]});
    std::sort(sides_.begin(), sides_.end());
  }
  void mark(MeshTriangle& t) const {
    for (std::size_t k = 0; k < 3 && !sides_.empty(); ++k) {
      const auto whole = lines_.whole(ends_of(t.corner[k], t.corner[(k + 1) % 3]));
      if (!whole) continue;
      const auto found = std::ranges::equal_range(sides_, *whole, {}, [](const auto& s) { return s.first; });
      if (found.empty()) continue;
      const std::uint8_t sides = found.front().second;
      const auto bit = static_cast<std::uint8_t>(1u << k);
      if (sides & kOutlineAbove) t.outlines[t.sheet.flipped ? 1 : 0] |= bit;
      if (sides & kOutlineBelow) t.outlines[t.sheet.flipped ? 0 : 1] |= bit;
    }
  }

 private:
  const DividedLines& lines_;
  std::vector<std::pair<Ends, std::uint8_t>> sides_;
};

std::vector<MeshTriangle> subdivide(FaceComplex& complex, const std::vector<PlaneGroup>& groups,
                                    std::span<const Material> materials, const std::vector<PlanarDomain>& domains,
                                    double longest, MeshReport& report, const Monitor& monitor) {
  DividedLines lines(complex, domains, longest);
  const auto draw_region = [&](std::size_t d) {
    return std::make_unique<RegionMesh>(complex, groups[domains[d].group], materials, lines.of_region(d),
                                        domains[d].points, longest);
  };

  // Most regions are done at once. They are put away as triangles, and drawn again if a neighbour halves their line.
  constexpr std::size_t kShelf = 256;
  std::vector<Shelf> shelves((domains.size() + kShelf - 1) / kShelf);
  std::vector<std::array<std::size_t, 2>> put_away(domains.size() + 1);  // first triangle and inner point in the shelf
  std::vector<std::unique_ptr<RegionMesh>> meshes(domains.size());
  std::vector<std::vector<Ends>> asked_by_shelf(shelves.size());
  monitor.report("mesh", 0);
  parallel_for(shelves.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end && !monitor.is_interrupted(); ++s)
      for (std::size_t d = s * kShelf; d < std::min(domains.size(), (s + 1) * kShelf); ++d) {
        Shelf& shelf = shelves[s];
        put_away[d] = {shelf.triangles.size(), shelf.inner.size()};
        if (keep_lone_face(complex, groups[domains[d].group], lines.of_region(d), domains[d].points, longest, shelf))
          continue;
        auto mesh = draw_region(d);
        shelf.cells += mesh->cell_count();
        shelf.overlapping += mesh->overlapping_count();
        const std::vector<Ends> asked = mesh->refine(true);
        asked_by_shelf[s].insert(asked_by_shelf[s].end(), asked.begin(), asked.end());
        if (asked.empty())
          mesh->collect(shelf);
        else
          meshes[d] = std::move(mesh);
      }
  });
  std::vector<Ends> all;
  for (const auto& some : asked_by_shelf) all.insert(all.end(), some.begin(), some.end());
  asked_by_shelf = {};

  for (int round = 1; round <= kRounds && !all.empty() && !monitor.is_interrupted(); ++round) {
    monitor.report("mesh", static_cast<double>(round) / (kRounds + 1));
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    std::vector<std::pair<std::uint32_t, Halving>> work;  // region, what to do there
    for (const Ends& e : all)
      lines.halve(complex, e, [&](std::uint32_t d, std::uint32_t middle) { work.push_back({d, {e, middle}}); });
    std::stable_sort(work.begin(), work.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
    std::vector<std::uint32_t> active;
    std::vector<std::size_t> begin_of;
    for (std::size_t k = 0; k < work.size(); ++k)
      if (k == 0 || work[k].first != work[k - 1].first) {
        active.push_back(work[k].first);
        begin_of.push_back(k);
      }
    begin_of.push_back(work.size());
    std::vector<std::vector<Ends>> asked(active.size());
    parallel_for(active.size(), 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        auto& mesh = meshes[active[k]];
        if (!mesh) {
          mesh = draw_region(active[k]);
          mesh->refine(true);
        }
        for (std::size_t w = begin_of[k]; w < begin_of[k + 1]; ++w)
          mesh->halve(work[w].second, complex.vertices[work[w].second.middle]);
        asked[k] = mesh->refine(round < kRounds);
      }
    });
    all.clear();
    for (const auto& some : asked) all.insert(all.end(), some.begin(), some.end());
  }

  std::vector<MeshTriangle> triangles;
  for (std::size_t s = 0; s < shelves.size(); ++s) {
    const std::size_t last = std::min(domains.size(), (s + 1) * kShelf);
    for (std::size_t d = s * kShelf; d < last; ++d) {
      Shelf own;
      std::span<const MeshTriangle> found;
      std::span<const Point2> inner;
      if (meshes[d]) {
        meshes[d]->collect(own);
        meshes[d].reset();
        found = own.triangles;
        inner = own.inner;
      } else {
        const auto [t0, p0] = put_away[d];
        const bool is_last = d + 1 == last;
        found = std::span(shelves[s].triangles)
                    .subspan(t0, (is_last ? shelves[s].triangles.size() : put_away[d + 1][0]) - t0);
        inner = std::span(shelves[s].inner).subspan(p0, (is_last ? shelves[s].inner.size() : put_away[d + 1][1]) - p0);
      }
      const auto first_inner = static_cast<std::uint32_t>(complex.vertices.size());
      for (const Point2& p : inner) complex.vertices.push_back(groups[domains[d].group].plane.lift(p));
      const OutlineEdges outlines(domains[d], lines);
      for (MeshTriangle t : found) {
        for (std::uint32_t& c : t.corner)
          if (c >= kInner) c = first_inner + (c - kInner);
        outlines.mark(t);
        triangles.push_back(t);
      }
    }
    report.planar_regions += shelves[s].cells;
    report.overlapping_regions += shelves[s].overlapping;
    shelves[s].triangles = {};
  }
  keep_each_once(triangles);
  return triangles;
}

}  // namespace clerestory
