#include "meshing/atlas/find_charts.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>

#include "meshing/atlas/plane_on_texels.h"
#include "meshing/atlas/raster.h"
#include "meshing/atlas/smallest_rectangle.h"
#include "solver/model/disjoint_sets.h"
#include "solver/model/parallel.h"

namespace clerestory {
namespace {

using Triangles = std::vector<std::uint32_t>;
using Pair = std::array<std::uint32_t, 2>;

constexpr std::uint32_t kNone = 0xffffffff;
constexpr double kFlat = 0.01;          // of a texel: corners this near to a plane lie in it
constexpr double kLargeFacet = 256;     // texels: from here on a facet of a bent surface is a chart of its own
constexpr double kBend = 25;            // degrees; texels are longer than asked for by 1 / cos at most
constexpr double kFull = 0.85;          // share of its rectangle from which on a chart is left as it is
constexpr double kWorthACut = 0.92;     // of the texels, with what gutters cost
constexpr double kSameLight = 0.01;     // relative; a texel for two lights that differ by less is half of that off
constexpr double kSmall = 300;          // texels that are not worth a cut
constexpr int kBeyondAnyAtlas = 20000;  // texels

/// Over each edge of each triangle, from corner k to the next, the other triangle with the same two points.
std::vector<std::array<std::uint32_t, 3>> triangles_across(const WrittenResult& result) {
  struct Edge {
    std::uint32_t low, high, triangle;
    std::uint8_t corner;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * result.triangles.size());
  for (std::uint32_t t = 0; t < result.triangles.size(); ++t)
    for (std::uint8_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(result.triangles[t][k], result.triangles[t][(k + 1) % 3]);
      edges.push_back({low, high, t, k});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.triangle, a.corner) < std::tie(b.low, b.high, b.triangle, b.corner);
  });
  std::vector<std::array<std::uint32_t, 3>> across(result.triangles.size(), {kNone, kNone, kNone});
  const auto same = [](const Edge& a, const Edge& b) { return a.low == b.low && a.high == b.high; };
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && same(edges[i], edges[end])) ++end;
    const Edge &a = edges[i], &b = edges[end - 1];
    if (end - i == 2 && a.low != a.high && a.triangle != b.triangle)
      across[a.triangle][a.corner] = b.triangle, across[b.triangle][b.corner] = a.triangle;
    i = end;
  }
  return across;
}

struct Piece {
  Triangles triangles;
  Vec3 normal;
  bool is_planar = true;
};

/// What a chart's texels say of it.
struct Inspection {
  std::uint64_t used = 0;
  std::vector<Pair> to_part;  ///< places in `triangles`; a lookup would mix their light
};

class ChartFinder {
 public:
  ChartFinder(const WrittenResult& result, double texels_per_metre)
      : result_(result),
        E_(result.of_points.at("irradiance")),
        texels_per_metre_(texels_per_metre),
        across_(triangles_across(result)) {
    for (const auto& [a, b, c] : result.triangles) {
      const Vec3 n = cross(result.points[b] - result.points[a], result.points[c] - result.points[a]) * 0.5;
      normal_.push_back(normalized(n));
      area_.push_back(length(n));
    }
  }

  std::vector<AtlasChart> charts(const Monitor& monitor) {
    const std::vector<Piece> pieces = whole_pieces();
    std::vector<std::uint32_t> of(result_.triangles.size());
    for (std::uint32_t i = 0; i < pieces.size(); ++i)
      for (const std::uint32_t t : pieces[i].triangles) of[t] = i;
    for (std::size_t t = 0; t < across_.size(); ++t)
      for (std::uint32_t& other : across_[t])
        if (other != kNone && of[other] != of[t]) other = kNone;

    seen_.assign(across_.size(), 0);
    std::vector<std::vector<AtlasChart>> of_piece(pieces.size());
    parallel_blocks(pieces.size(), 256, 1, "charts", monitor, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) of_piece[i] = cut(pieces[i]);
      return 0;
    });
    std::vector<AtlasChart> all;
    for (auto& some : of_piece) std::move(some.begin(), some.end(), std::back_inserter(all));
    std::sort(all.begin(), all.end(),
              [](const AtlasChart& a, const AtlasChart& b) { return a.triangles.front() < b.triangles.front(); });
    return all;
  }

 private:
  const std::array<std::uint32_t, 3>& corners(std::uint32_t t) const { return result_.triangles[t]; }

  /// Triangles from `seed` on over shared edges of one surface that `belongs` takes; `taken` tells who is, and learns
  /// it.
  template <class Belongs>
  Triangles grow(std::uint32_t seed, std::vector<std::uint8_t>& taken, const Belongs& belongs) const {
    Triangles grown{seed};
    taken[seed] = 1;
    for (std::size_t i = 0; i < grown.size(); ++i)
      for (const std::uint32_t t : across_[grown[i]])
        if (t != kNone && !taken[t] && result_.surface[t] == result_.surface[seed] && belongs(t)) {
          taken[t] = 1;
          grown.push_back(t);
        }
    std::sort(grown.begin(), grown.end());
    return grown;
  }

  Triangles largest_first() const {
    Triangles order(area_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return area_[a] > area_[b]; });
    return order;
  }

  /// Flat parts, and small facets joined as long as they bend little.
  std::vector<Piece> whole_pieces() const {
    const Triangles order = largest_first();
    std::vector<std::uint8_t> taken(order.size(), 0), is_large(order.size(), 0);
    std::vector<Vec3> facet_normal(order.size());
    std::vector<Piece> pieces;
    const double flat = kFlat / texels_per_metre_;
    for (const std::uint32_t seed : order) {
      if (taken[seed]) continue;
      const Vec3 n = normal_[seed], at = result_.points[corners(seed)[0]];
      Triangles facet = grow(seed, taken, [&](std::uint32_t t) {
        const auto is_in_plane = [&](std::uint32_t p) { return std::abs(dot(result_.points[p] - at, n)) <= flat; };
        return (area_[t] == 0 || dot(normal_[t], n) > 0.9) && std::ranges::all_of(corners(t), is_in_plane);
      });
      double area = 0;
      for (const std::uint32_t t : facet) area += area_[t], facet_normal[t] = n;
      if (area * texels_per_metre_ * texels_per_metre_ < kLargeFacet) continue;
      for (const std::uint32_t t : facet) is_large[t] = 1;
      pieces.push_back({std::move(facet), n, true});
    }
    taken = is_large;
    const double least = std::cos(kBend * std::numbers::pi / 180);
    for (const std::uint32_t seed : order) {
      if (taken[seed]) continue;
      const Vec3 n = normal_[seed];
      Piece piece{{}, n, true};
      piece.triangles = grow(seed, taken, [&](std::uint32_t t) {
        return area_[t] == 0 || (dot(facet_normal[t], n) >= least && dot(normal_[t], n) > 0.5);
      });
      const Vec3 at = result_.points[corners(seed)[0]];
      for (const std::uint32_t t : piece.triangles)
        for (const std::uint32_t p : corners(t))
          piece.is_planar = piece.is_planar && std::abs(dot(result_.points[p] - at, n)) <= flat;
      pieces.push_back(std::move(piece));
    }
    return pieces;
  }

  AtlasChart laid_flat(const Piece& piece) const {
    AtlasChart chart;
    chart.triangles = piece.triangles;
    chart.surface = result_.surface[piece.triangles.front()];
    chart.is_planar = piece.is_planar;
    chart.normal = length(piece.normal) > 0 ? piece.normal : Vec3{0, 0, 1};
    const Frame frame(chart.normal);
    const Vec3 at = result_.points[corners(piece.triangles.front())[0]];
    std::vector<std::array<double, 2>> flat;
    for (const std::uint32_t t : piece.triangles) {
      chart.area += area_[t];
      for (const std::uint32_t p : corners(t))
        flat.push_back({dot(result_.points[p] - at, frame.t), dot(result_.points[p] - at, frame.b)});
    }
    const TurnedRectangle r = smallest_rectangle(std::move(flat));
    const Vec3 first = frame.t * r.axis[0] + frame.b * r.axis[1], second = frame.b * r.axis[0] - frame.t * r.axis[1];
    chart.origin = at + first * r.low[0] + second * r.low[1];
    const auto divide = [&](double length, const Vec3& axis, int& texels, Vec3& step) {
      texels = std::max(
          piece.triangles.size() > 2 ? 4 : 2,
          1 + static_cast<int>(std::min<double>(kBeyondAnyAtlas, std::ceil(length * texels_per_metre_ - 1e-4))));
      step = axis * (length > 0 ? length / (texels - 1) : 1 / texels_per_metre_);
    };
    divide(r.high[0] - r.low[0], first, chart.width, chart.u);
    divide(r.high[1] - r.low[1], second, chart.height, chart.v);
    return chart;
  }

  std::vector<std::array<Texel, 3>> texels_of(const AtlasChart& chart) const {
    std::vector<std::array<Texel, 3>> texels;
    for (const std::uint32_t t : chart.triangles) {
      const auto& [a, b, c] = corners(t);
      texels.push_back(
          {chart.texel_of(result_.points[a]), chart.texel_of(result_.points[b]), chart.texel_of(result_.points[c])});
    }
    return texels;
  }

  Inspection inspect(const AtlasChart& chart, const std::vector<std::array<Texel, 3>>& texels) const {
    const int columns = chart.width - 1, rows = chart.height - 1;
    const auto n_cells = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    const auto cell = [&](int x, int y) {
      return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x);
    };
    Inspection found;

    std::vector<std::uint8_t> is_rim(n_cells, 0);
    for (std::size_t i = 0; i < texels.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        if (across_[chart.triangles[i]][k] != kNone) continue;
        const Texel &a = texels[i][k], &b = texels[i][(k + 1) % 3];
        for_rows_of_cells({a, b, b}, columns, rows, [&](int y, int first, int last) {
          for (int x = first; x <= last; ++x) is_rim[cell(x, y)] = 1;
        });
      }
    // A texel of such a cell is reached from the four around it: those are where somebody else may be.
    std::vector<std::uint32_t> list_of(n_cells, kNone);
    std::uint32_t lists = 0;
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x) {
        bool near = false;
        for (int j = std::max(0, y - 1); j <= std::min(rows - 1, y + 1); ++j)
          for (int i = std::max(0, x - 1); i <= std::min(columns - 1, x + 1); ++i) near = near || is_rim[cell(i, j)];
        if (near) list_of[cell(x, y)] = lists++;
      }
    std::vector<std::uint8_t> touched(n_cells, 0);
    std::vector<std::uint32_t> start(lists + 1, 0), entry;
    const auto for_entries = [&](const auto& visit) {
      for (std::uint32_t i = 0; i < texels.size(); ++i)
        for_rows_of_cells(texels[i], columns, rows, [&](int y, int first, int last) {
          for (int x = first; x <= last; ++x) {
            touched[cell(x, y)] = 1;
            if (list_of[cell(x, y)] != kNone) visit(list_of[cell(x, y)], i);
          }
        });
    };
    for_entries([&](std::uint32_t list, std::uint32_t) { ++start[list + 1]; });
    std::partial_sum(start.begin(), start.end(), start.begin());
    entry.resize(start.back());
    std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
    for_entries([&](std::uint32_t list, std::uint32_t i) { entry[next[list]++] = i; });

    Triangles here;
    for (int y = 0; y < chart.height; ++y)
      for (int x = 0; x < chart.width; ++x) {
        here.clear();
        bool near = false;
        for (int j = std::max(0, y - 1); j <= std::min(rows - 1, y); ++j)
          for (int i = std::max(0, x - 1); i <= std::min(columns - 1, x); ++i) {
            if (!is_rim[cell(i, j)]) continue;
            near = true;
          }
        if (!near) continue;
        for (int j = std::max(0, y - 1); j <= std::min(rows - 1, y); ++j)
          for (int i = std::max(0, x - 1); i <= std::min(columns - 1, x); ++i) {
            const std::uint32_t list = list_of[cell(i, j)];
            here.insert(here.end(), entry.begin() + start[list], entry.begin() + start[list + 1]);
          }
        note_strangers(chart, texels, {double{1} * x, double{1} * y}, here, found.to_part);
      }
    note_overlaps(texels, columns, rows, found.to_part);
    std::sort(found.to_part.begin(), found.to_part.end());
    found.to_part.erase(std::unique(found.to_part.begin(), found.to_part.end()), found.to_part.end());

    // A cell's four texels and those around them.
    std::vector<std::uint8_t> used(
        static_cast<std::size_t>(chart.width + 2) * static_cast<std::size_t>(chart.height + 2), 0);
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x)
        if (touched[cell(x, y)])
          for (int j = 0; j < 4; ++j)
            std::fill_n(used.begin() + static_cast<std::ptrdiff_t>(y + j) * (chart.width + 2) + x, 4, std::uint8_t{1});
    found.used = static_cast<std::uint64_t>(std::count(used.begin(), used.end(), 1));
    return found;
  }

  /// Of triangles (places in the chart's list) that one texel is reached from: pairs that do not hang together there
  /// and have other light.
  void note_strangers(const AtlasChart& chart, const std::vector<std::array<Texel, 3>>& texels, const Texel& texel,
                      Triangles& here, std::vector<Pair>& pairs) const {
    std::sort(here.begin(), here.end());
    here.erase(std::unique(here.begin(), here.end()), here.end());
    if (here.size() < 2) return;
    DisjointSets sets(here.size());
    for (std::size_t i = 0; i < here.size(); ++i)
      for (const std::uint32_t t : across_[chart.triangles[here[i]]]) {
        if (t == kNone) continue;
        const auto place =
            std::lower_bound(chart.triangles.begin(), chart.triangles.end(), t) - chart.triangles.begin();
        const auto found = std::lower_bound(here.begin(), here.end(), static_cast<std::uint32_t>(place));
        if (found != here.end() && *found == place) sets.join(i, static_cast<std::size_t>(found - here.begin()));
      }
    bool are_together = true;
    for (std::size_t i = 1; i < here.size(); ++i) are_together = are_together && sets.find(i) == sets.find(0);
    if (are_together) return;
    std::vector<Mean> mean(here.size());
    for (std::size_t i = 0; i < here.size(); ++i)
      mean[sets.find(i)].add(light_at(chart.triangles[here[i]], texels[here[i]], texel));
    for (std::size_t i = 1; i < here.size(); ++i)
      if (sets.find(i) != sets.find(0) && mean[sets.find(i)].differs_from(mean[sets.find(0)]))
        pairs.push_back({here[0], here[i]});
  }

  struct Mean {
    Spectrum sum;
    double count = 0;
    void add(const Spectrum& x) { sum += x, count += 1; }
    bool differs_from(const Mean& other) const {
      const Spectrum a = sum / count, b = other.sum / other.count;
      bool differs = false;
      for (int k = 0; k < kMaxChannels; ++k)
        differs = differs || std::abs(a[k] - b[k]) > kSameLight * std::max(std::abs(a[k]), std::abs(b[k]));
      return differs;
    }
  };

  /// Irradiance of the triangle's plane at a texel.
  Spectrum light_at(std::uint32_t t, const std::array<Texel, 3>& texels, const Texel& texel) const {
    const auto& [a, b, c] = corners(t);
    const auto n = static_cast<std::size_t>(E_.components);
    Spectrum light;
    for (std::size_t k = 0; k < n; ++k)
      light[static_cast<int>(k)] =
          plane_of(texels, {E_.value[a * n + k], E_.value[b * n + k], E_.value[c * n + k]}).beyond(texel[0], texel[1]);
    return light;
  }

  /// Triangles of which both have the middle of a cell inside.
  static void note_overlaps(const std::vector<std::array<Texel, 3>>& texels, int columns, int rows,
                            std::vector<Pair>& pairs) {
    std::vector<std::uint32_t> owner(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), kNone);
    for (std::uint32_t i = 0; i < texels.size(); ++i) {
      const auto& t = texels[i];
      const auto [low, high] = std::minmax({t[0][1], t[1][1], t[2][1]});
      for (int y = std::max(0, static_cast<int>(low - 0.5)); y < rows && y + 0.5 < high; ++y) {
        const auto [left, right] = x_range(t, y + 0.5, y + 0.5);
        for (int x = std::max(0, static_cast<int>(left - 0.5)); x < columns && x + 0.5 < right - 1e-4; ++x) {
          if (x + 0.5 <= left + 1e-4) continue;
          std::uint32_t& first =
              owner[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x)];
          if (first == kNone)
            first = i;
          else if (first != i)
            pairs.push_back({first, i});
        }
      }
    }
  }

  struct Cut {
    double cost = 1e300;  ///< texels of both parts, and a penalty for what it leaves together
    std::size_t axis = 0, first = 0;
  };

  /// The cut across one of the axes that leaves the smallest rectangles: `order` gets the triangles' places by centre,
  /// of which the first `first` are one part.
  static Cut best_cut(const std::vector<std::array<Texel, 3>>& texels, const std::vector<Pair>& to_part, bool in_middle,
                      std::array<Triangles, 2>& order) {
    Cut best;
    const std::size_t n = texels.size();
    double whole = 0;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const auto centre = [&](std::uint32_t i) { return texels[i][0][axis] + texels[i][1][axis] + texels[i][2][axis]; };
      order[axis].resize(n);
      std::iota(order[axis].begin(), order[axis].end(), 0u);
      std::stable_sort(order[axis].begin(), order[axis].end(),
                       [&](std::uint32_t a, std::uint32_t b) { return centre(a) < centre(b); });
      // Rectangle of the first i, and of the others.
      const auto sizes = [&](auto begin, auto end) {
        std::vector<double> size{0};
        Texel low{1e300, 1e300}, high{-1e300, -1e300};
        for (auto i = begin; i != end; ++i) {
          for (const Texel& p : texels[*i])
            for (std::size_t k = 0; k < 2; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
          size.push_back((high[0] - low[0] + 3.5) * (high[1] - low[1] + 3.5));
        }
        return size;
      };
      const std::vector<double> before = sizes(order[axis].begin(), order[axis].end());
      const std::vector<double> after = sizes(order[axis].rbegin(), order[axis].rend());
      whole = before.back();
      std::vector<std::uint32_t> place(n);
      for (std::uint32_t i = 0; i < n; ++i) place[order[axis][i]] = i;
      std::vector<double> parted(n + 1, 0);
      for (const auto& [a, b] : to_part) {
        const auto [low, high] = std::minmax(place[a], place[b]);
        parted[low + 1] += 1, parted[high + 1] -= 1;
      }
      double now = 0;
      for (std::size_t first = 1; first < n; ++first) {
        now += parted[first];
        double cost = before[first] + after[n - first];
        if (!to_part.empty()) cost += 2 * whole * (1 - now / static_cast<double>(to_part.size()));
        if (in_middle) cost = std::max(before[first], after[n - first]);
        if (cost < best.cost) best = {cost, axis, first};
      }
    }
    return best;
  }

  /// Parts that hang together; links to others are gone.
  void separate(Triangles& some, const Piece& of, std::vector<Piece>& parts) {
    for (const std::uint32_t t : some) seen_[t] = 1;
    for (const std::uint32_t t : some)
      for (std::uint32_t& other : across_[t])
        if (other != kNone && !seen_[other]) {
          for (std::uint32_t& back : across_[other])
            if (back == t) back = kNone;
          other = kNone;
        }
    for (const std::uint32_t t : some) seen_[t] = 0;
    for (const std::uint32_t t : some)
      if (!seen_[t]) parts.push_back({grow(t, seen_, [](std::uint32_t) { return true; }), of.normal, of.is_planar});
    for (const std::uint32_t t : some) seen_[t] = 0;
  }

  std::vector<AtlasChart> cut(const Piece& whole) {
    std::vector<AtlasChart> done;
    std::vector<Piece> todo{whole};
    while (!todo.empty()) {
      const Piece piece = std::move(todo.back());
      todo.pop_back();
      AtlasChart chart = laid_flat(piece);
      const auto texels = texels_of(chart);
      const bool is_long = std::max(chart.width, chart.height) > kLongestChart && texels.size() > 1;
      Inspection found;
      if (!is_long) found = inspect(chart, texels);
      const double all = (chart.width + 2.0) * (chart.height + 2.0);
      if (texels.size() > 1 &&
          (is_long || !found.to_part.empty() || (all > kSmall && static_cast<double>(found.used) < kFull * all))) {
        std::array<Triangles, 2> order;
        const Cut c = best_cut(texels, found.to_part, is_long, order);
        if (is_long || !found.to_part.empty() || c.cost < kWorthACut * all) {
          for (const bool second : {false, true}) {
            Triangles part;
            for (std::size_t i = second ? c.first : 0; i < (second ? texels.size() : c.first); ++i)
              part.push_back(piece.triangles[order[c.axis][i]]);
            separate(part, piece, todo);
          }
          continue;
        }
      }
      chart.used = found.used;
      done.push_back(std::move(chart));
    }
    return done;
  }

  const WrittenResult& result_;
  const WrittenArray& E_;
  double texels_per_metre_;
  std::vector<std::array<std::uint32_t, 3>> across_;
  std::vector<Vec3> normal_;  ///< unit; zero where a triangle has no area
  std::vector<double> area_;
  std::vector<std::uint8_t> seen_;  ///< scratch; each piece writes at its own triangles
};

}  // namespace

std::vector<AtlasChart> find_charts(const WrittenResult& result, double texels_per_metre, const Monitor& monitor) {
  return ChartFinder(result, texels_per_metre).charts(monitor);
}

}  // namespace clerestory
