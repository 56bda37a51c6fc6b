#include "meshing/imprint_contacts.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <deque>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "meshing/find_contacts.h"
#include "meshing/point_index.h"
#include "solver/model/box_tree.h"
#include "solver/model/parallel.h"

namespace clerestory {
namespace {

/// Vertices on a line beside its ends, from its start to its end.
using Stops = std::vector<std::uint32_t>;

template <class Drawn>
void keep_unique(std::vector<Drawn>& lines) {
  std::sort(lines.begin(), lines.end());
  lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
}

std::vector<Ends> distinct_ends(const Drawing& drawing) {
  std::vector<Ends> ends;
  ends.reserve(drawing.lines.size() + drawing.outlines.size());
  for (const Line& l : drawing.lines) ends.push_back({l.a, l.b});
  for (const OutlineLine& o : drawing.outlines) ends.push_back({o.line.a, o.line.b});
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return ends;
}

/// Vertices that came into use together, by place.
struct Layer {
  Layer(const FaceComplex& complex, std::vector<std::uint32_t> vertices)
      : vertex(std::move(vertices)), tree(vertex.size(), {&complex, &vertex}) {}
  struct BoxOfVertex {
    const FaceComplex* complex;
    const std::vector<std::uint32_t>* vertex;
    Box operator()(std::uint32_t i) const {
      Box box;
      box.add(complex->vertices[(*vertex)[i]]);
      return box.grown(1.01 * complex->tolerance[(*vertex)[i]]);
    }
  };
  std::vector<std::uint32_t> vertex;
  BoxTree<BoxOfVertex> tree;
};

/// Splits lines at vertices that lie on them. Remembers which lines have met which vertices: in a further round only
/// new lines look at all vertices, and the others at new vertices.
class LineSplitter {
 public:
  explicit LineSplitter(const FaceComplex& complex) : complex_(complex) {}

  /// Also splits at the `forced` vertices. `drawing.lines` is sorted and unique, before and after. Returns at how many
  /// vertices below `first_new` distinct lines were split.
  std::size_t split(Drawing& drawing, const std::map<Ends, Stops>& forced, std::uint32_t first_new) {
    const std::vector<Ends> ends = distinct_ends(drawing);
    const std::size_t before = layers_.size();
    add_layer(drawing, ends, forced);
    // By where they start: lines that start together look together, and those nearby next.
    std::vector<std::uint32_t> begin_at(complex_.vertices.size() + 1, 0);
    for (const Ends& e : ends) ++begin_at[e[0] + 1];
    std::partial_sum(begin_at.begin(), begin_at.end(), begin_at.begin());
    std::vector<Split> splits;
    const CrowdLimit limit{"places where a corner lies on an edge", 3'000'000 + 10 * ends.size()};
    std::atomic<std::size_t> stops = 0;
    for (const Layer& layer : layers_) {
      const auto& order = layer.tree.order();
      std::vector<std::vector<Split>> found((order.size() + kGrain - 1) / kGrain);
      parallel_for(found.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t chunk = begin; chunk < end; ++chunk)
          for (std::size_t k = chunk * kGrain; k < std::min(order.size(), (chunk + 1) * kGrain); ++k) {
            const std::uint32_t v = layer.vertex[order[k]];
            const auto fan = std::span(ends).subspan(begin_at[v], begin_at[v + 1] - begin_at[v]);
            // Each node of the tree is asked by all lines of a fan: a wide one goes in parts.
            const std::size_t splits_before = found[chunk].size();
            for (std::size_t first = 0; first < fan.size() && stops <= limit.most; first += kFan)
              split_fan(fan.subspan(first, std::min(kFan, fan.size() - first)), before, forced, found[chunk]);
            for (std::size_t s = splits_before; s < found[chunk].size(); ++s) stops += found[chunk][s].stops.size();
          }
      });
      for (auto& some : found) splits.insert(splits.end(), some.begin(), some.end());
    }
    limit.check(stops, complex_);
    std::sort(splits.begin(), splits.end(), [](const Split& x, const Split& y) { return x.line < y.line; });
    const auto is_split = [&](const Ends& e) {
      const auto at = std::lower_bound(splits.begin(), splits.end(), e,
                                       [](const Split& s, const Ends& value) { return s.line < value; });
      return at != splits.end() && at->line == e ? &*at : nullptr;
    };
    checked_.clear();
    std::copy_if(ends.begin(), ends.end(), std::back_inserter(checked_), [&](const Ends& e) { return !is_split(e); });
    if (splits.empty()) return 0;

    std::size_t at_old = 0;
    for (const Split& s : splits)
      at_old += static_cast<std::size_t>(
          std::count_if(s.stops.begin(), s.stops.end(), [&](auto v) { return v < first_new; }));
    const auto cut = [&](const Line& l, const auto& add) {
      std::uint32_t from = l.a;
      if (const Split* s = is_split({l.a, l.b}))
        for (const std::uint32_t v : s->stops) {
          add(line(l.group, from, v));
          from = v;
        }
      add(line(l.group, from, l.b));
    };
    std::vector<Line> pieces;
    pieces.reserve(drawing.lines.size() + 2 * splits.size());
    for (const Line& l : drawing.lines) cut(l, [&](const Line& piece) { pieces.push_back(piece); });
    drawing.lines = std::move(pieces);
    keep_unique(drawing.lines);
    std::vector<OutlineLine> outlines;
    for (const OutlineLine& o : drawing.outlines)
      cut(o.line, [&](const Line& piece) { outlines.push_back({piece, o.above}); });
    drawing.outlines = std::move(outlines);
    keep_unique(drawing.outlines);
    return at_old;
  }

 private:
  static constexpr std::size_t kGrain = 1024, kFan = 64;
  struct Split {
    Ends line;
    Stops stops;
  };

  /// The vertices in use that are in no layer yet.
  void add_layer(const Drawing& drawing, const std::vector<Ends>& ends, const std::map<Ends, Stops>& forced) {
    in_layer_.resize(complex_.vertices.size());
    std::vector<std::uint32_t> fresh;
    const auto use = [&](std::uint32_t v) {
      if (!in_layer_[v]) fresh.push_back(v);
      in_layer_[v] = true;
    };
    for (const Ends& e : ends) use(e[0]), use(e[1]);
    for (const auto& [group, v] : drawing.points) use(v);
    for (const auto& [e, stops] : forced)
      for (const std::uint32_t v : stops) use(v);
    std::sort(fresh.begin(), fresh.end());
    if (!fresh.empty()) layers_.emplace_back(complex_, std::move(fresh));
  }

  /// Lines that start at one vertex. Those that were checked look at layers from `fresh` on only.
  void split_fan(std::span<const Ends> fan, std::size_t fresh, const std::map<Ends, Stops>& forced,
                 std::vector<Split>& found) const {
    struct Ray {
      Vec3 a, b;
      Box around;  ///< asked first, being cheaper
      std::size_t first_layer;
      std::vector<std::pair<double, std::uint32_t>> on;
    };
    std::vector<Ray> rays(fan.size());
    Box around;
    std::size_t first_layer = layers_.size();
    for (std::size_t k = 0; k < fan.size(); ++k) {
      Ray& r = rays[k];
      r.a = complex_.vertices[fan[k][0]], r.b = complex_.vertices[fan[k][1]];
      r.around.add(r.a);
      r.around.add(r.b);
      around.add(r.around);
      r.first_layer = std::binary_search(checked_.begin(), checked_.end(), fan[k]) ? fresh : 0;
      first_layer = std::min(first_layer, r.first_layer);
    }
    for (std::size_t layer = first_layer; layer < layers_.size(); ++layer) {
      const auto meets = [&](const Ray& r, const Box& box) {
        return r.first_layer <= layer && box.touches(r.around) && box.touches_segment(r.a, r.b);
      };
      layers_[layer].tree.visit_if(
          [&](const Box& box) {
            return box.touches(around) && std::any_of(rays.begin(), rays.end(), [&](auto& r) { return meets(r, box); });
          },
          [&](std::uint32_t i) {
            const std::uint32_t v = layers_[layer].vertex[i];
            const Vec3& p = complex_.vertices[v];
            for (std::size_t k = 0; k < fan.size(); ++k) {
              Ray& r = rays[k];
              if (v == fan[k][0] || v == fan[k][1] || r.first_layer > layer) continue;
              const Vec3 d = r.b - r.a;
              const double t = dot(p - r.a, d) / dot(d, d);
              if (t <= 0 || t >= 1) continue;
              const double tolerance = std::min(complex_.line_tolerance(fan[k][0], fan[k][1]), complex_.tolerance[v]);
              if (length(p - r.a - d * t) <= tolerance) r.on.push_back({t, v});
            }
          });
    }
    for (std::size_t k = 0; k < fan.size(); ++k) {
      auto& on = rays[k].on;
      if (const auto it = forced.find(fan[k]); it != forced.end())
        for (const std::uint32_t v : it->second) {
          const Vec3 d = rays[k].b - rays[k].a;
          if (const double t = dot(complex_.vertices[v] - rays[k].a, d) / dot(d, d); t > 0 && t < 1)
            on.push_back({t, v});
        }
      if (on.empty()) continue;
      std::sort(on.begin(), on.end());
      on.erase(std::unique(on.begin(), on.end()), on.end());
      Split split{fan[k], {}};
      for (const auto& [t, v] : on) split.stops.push_back(v);
      found.push_back(std::move(split));
    }
  }

  const FaceComplex& complex_;
  std::vector<bool> in_layer_;
  std::deque<Layer> layers_;
  std::vector<Ends> checked_;  ///< sorted: lines that have met all layers
};

struct Crossing {
  Ends first, second;
  Vec3 place;
  double tolerance;
};

/// How much crossings() may do for all planes; what is beyond is left undone.
struct CrossingCount {
  explicit CrossingCount(std::size_t lines)
      : met_limit{"pairs of edges of one plane touch by their boxes", 20'000'000 + 200 * lines},
        found_limit{"places where edges of one plane cross", 50'000 + lines} {}
  bool is_over() const { return met > met_limit.most || found > found_limit.most; }
  void check(const FaceComplex& complex) const {
    found_limit.check(found, complex);
    met_limit.check(met, complex);
  }
  CrowdLimit met_limit, found_limit;
  std::atomic<std::size_t> met = 0, found = 0;
};

/// Where lines of one group cross away from their ends.
std::vector<Crossing> crossings(const FaceComplex& complex, const Plane& plane, std::span<const Line> lines,
                                CrossingCount& count) {
  std::vector<Crossing> found;
  std::vector<std::array<Point2, 2>> flat;
  std::vector<Box> boxes;
  for (const Line& l : lines) {
    flat.push_back({plane.flatten(complex.vertices[l.a]), plane.flatten(complex.vertices[l.b])});
    Box box;
    for (const Point2& p : flat.back()) box.add(Vec3{p.x, p.y, 0});
    boxes.push_back(box);
  }
  const auto test = [&](std::size_t i, std::size_t j) {
    const Line &li = lines[i], &lj = lines[j];
    if (li.a == lj.a || li.a == lj.b || li.b == lj.a || li.b == lj.b) return;
    const auto& [p, q] = flat[i];
    const auto& [r, s] = flat[j];
    const double dx = q.x - p.x, dy = q.y - p.y, ex = s.x - r.x, ey = s.y - r.y;
    const double det = dx * ey - dy * ex;
    const double li2 = std::hypot(dx, dy), lj2 = std::hypot(ex, ey);
    if (std::abs(det) <= 1e-12 * li2 * lj2) return;
    const double u = ((r.x - p.x) * ey - (r.y - p.y) * ex) / det, v = ((r.x - p.x) * dy - (r.y - p.y) * dx) / det;
    if (!(u > 0 && u < 1 && v > 0 && v < 1)) return;
    const Vec3 a = complex.vertices[li.a], b = complex.vertices[li.b], c = complex.vertices[lj.a],
               d = complex.vertices[lj.b];
    found.push_back({{li.a, li.b},
                     {lj.a, lj.b},
                     ((a + (b - a) * u) + (c + (d - c) * v)) / 2,
                     std::min(complex.line_tolerance(li.a, li.b), complex.line_tolerance(lj.a, lj.b))});
  };
  if (lines.size() < 24) {
    for (std::size_t i = 0; i < lines.size(); ++i)
      for (std::size_t j = i + 1; j < lines.size(); ++j)
        if (boxes[i].touches(boxes[j])) test(i, j);
    return found;
  }
  const BoxTree tree(lines.size(), [&](std::uint32_t i) -> const Box& { return boxes[i]; });
  for (std::size_t i = 0; i < lines.size() && !count.is_over(); ++i) {
    const std::size_t found_before = found.size();
    std::size_t met = 0;
    tree.visit_if(
        [&](const Box& b) {
          return b.touches(boxes[i]) &&
                 b.touches_segment({flat[i][0].x, flat[i][0].y, 0}, {flat[i][1].x, flat[i][1].y, 0});
        },
        [&](std::uint32_t j) {
          ++met;
          if (j > i) test(i, j);
        });
    count.met += met;
    count.found += found.size() - found_before;
  }
  return found;
}

std::vector<std::vector<Crossing>> crossings_by_group(const FaceComplex& complex, const std::vector<PlaneGroup>& groups,
                                                      const std::vector<Line>& lines) {
  std::vector<std::size_t> begin_of(groups.size() + 1, lines.size());
  for (std::size_t k = lines.size(); k-- > 0;) begin_of[lines[k].group] = k;
  for (std::size_t g = groups.size(); g-- > 0;) begin_of[g] = std::min(begin_of[g], begin_of[g + 1]);
  std::vector<std::vector<Crossing>> found(groups.size());
  CrossingCount count(lines.size());
  parallel_for(groups.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end && !count.is_over(); ++g)
      if (begin_of[g + 1] - begin_of[g] > 3)
        found[g] = crossings(complex, groups[g].plane,
                             std::span(lines).subspan(begin_of[g], begin_of[g + 1] - begin_of[g]), count);
  });
  count.check(complex);
  return found;
}

/// Rather a line less than a drawing that crosses itself: drops one of each two that cross.
void drop_crossing(std::vector<Line>& lines, const std::vector<std::vector<Crossing>>& found) {
  std::vector<Line> dropped;
  for (std::uint32_t g = 0; g < found.size(); ++g)
    for (const Crossing& c : found[g]) dropped.push_back(line(g, c.second[0], c.second[1]));
  keep_unique(dropped);
  std::vector<Line> kept;
  std::set_difference(lines.begin(), lines.end(), dropped.begin(), dropped.end(), std::back_inserter(kept));
  lines = std::move(kept);
}

}  // namespace

void split_at_vertices(const FaceComplex& complex, Drawing& drawing) {
  keep_unique(drawing.lines);
  LineSplitter(complex).split(drawing, {}, 0);
}

Drawing imprint_contacts(FaceComplex& complex, const std::vector<PlaneGroup>& groups, std::span<const Outline> outlines,
                         MeshReport& report) {
  Drawing drawing;
  std::vector<std::uint32_t> group_of(complex.faces.size());
  drawing.lines.reserve(3 * complex.faces.size());
  for (std::uint32_t g = 0; g < groups.size(); ++g)
    for (const std::uint32_t f : groups[g].faces) {
      group_of[f] = g;
      const auto& c = complex.faces[f].corner;
      for (std::size_t k = 0; k < 3; ++k) drawing.lines.push_back(line(g, c[k], c[(k + 1) % 3]));
    }
  keep_unique(drawing.lines);
  const auto first_new = static_cast<std::uint32_t>(complex.vertices.size());
  // T-junctions: vertices of the model inside edges of the model.
  LineSplitter splitter(complex);
  report.t_junctions = splitter.split(drawing, {}, first_new);

  PointIndex index(complex.vertices, complex.allowed.contact);
  for (std::uint32_t v = 0; v < first_new; ++v) index.add(v);
  const auto vertex_at = [&](const Vec3& p, double tolerance) {
    const std::uint32_t known = index.find(p, tolerance);
    if (known != PointIndex::kNone) return known;
    const std::uint32_t id = complex.add_vertex(p, tolerance);
    index.add(id);
    return id;
  };

  for (const Contact& c : find_contacts(complex, groups, group_of)) {
    const std::uint32_t a = vertex_at(c.end[0], c.tolerance), b = vertex_at(c.end[1], c.tolerance);
    for (const std::uint32_t face : {c.face_a, c.face_b}) {
      if (a != b) drawing.lines.push_back(line(group_of[face], a, b));
      const auto& corner = complex.faces[face].corner;
      if (a == b && std::find(corner.begin(), corner.end(), a) == corner.end())
        drawing.points.push_back({group_of[face], a});
    }
  }
  for (const Outline& o : outlines) {
    const std::uint32_t a = vertex_at(o.end[0], o.tolerance), b = vertex_at(o.end[1], o.tolerance);
    if (a == b) continue;
    drawing.lines.push_back(line(o.group, a, b));
    drawing.outlines.push_back({drawing.lines.back(), o.above});
  }
  keep_unique(drawing.lines);
  keep_unique(drawing.outlines);
  std::sort(drawing.points.begin(), drawing.points.end());
  drawing.points.erase(std::unique(drawing.points.begin(), drawing.points.end()), drawing.points.end());

  std::map<Ends, Stops> forced;
  // New vertices may lie on other lines, and a line bent to a vertex may cross another: until nothing changes. Exact
  // models settle in one or two rounds.
  const std::size_t too_many = 1000 + 3 * complex.vertices.size();
  constexpr int kRounds = 8;
  for (int round = 0;; ++round) {
    splitter.split(drawing, forced, 0);
    forced.clear();
    const auto found = crossings_by_group(complex, groups, drawing.lines);
    std::size_t count = 0;
    for (const auto& some : found) count += some.size();
    if (count == 0) break;
    if (round == kRounds || complex.vertices.size() > too_many || (round > 0 && count > drawing.lines.size())) {
      drawing.settled = false;
      drop_crossing(drawing.lines, found);
      break;
    }
    for (const auto& some : found)
      for (const Crossing& c : some) {
        const std::uint32_t v = vertex_at(c.place, c.tolerance);
        for (const Ends& e : {c.first, c.second})
          if (v != e[0] && v != e[1]) forced[e].push_back(v);
      }
    if (forced.empty()) break;
  }
  return drawing;
}

}  // namespace clerestory
