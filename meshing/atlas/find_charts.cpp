#include "meshing/atlas/find_charts.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>

#include "meshing/atlas/cut_chart.h"
#include "meshing/atlas/inspect_chart.h"
#include "meshing/atlas/smallest_rectangle.h"
#include "meshing/atlas/triangles_across.h"
#include "solver/model/parallel.h"

namespace clerestory {
namespace {

using Triangles = std::vector<std::uint32_t>;

constexpr double kFlat = 0.01;       // of a texel: corners this near to a plane lie in it
constexpr double kLargeFacet = 256;  // texels: from here on a facet of a bent surface is a chart of its own
constexpr double kBend = 25;         // degrees; texels are longer than asked for by 1 / cos at most
constexpr double kFull = 0.85;       // share of its rectangle from which on a chart is left as it is
constexpr double kWorthACut = 0.92;  // of the texels, with what gutters cost
constexpr std::size_t kMany = 4096, kUneven = 16;
constexpr double kSmall = 300;          // texels that are not worth a cut
constexpr int kBeyondAnyAtlas = 20000;  // texels

struct Piece {
  Triangles triangles;
  Vec3 normal;
  bool is_planar = true;
};

class ChartFinder {
 public:
  ChartFinder(const WrittenResult& result, double texels_per_metre)
      : result_(result), texels_per_metre_(texels_per_metre), across_(triangles_across(result)) {
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
        if (other != kNoTriangle && of[other] != of[t]) other = kNoTriangle;

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
        if (t != kNoTriangle && !taken[t] && result_.surface[t] == result_.surface[seed] && belongs(t)) {
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

  /// Parts that hang together; links to others are gone.
  void separate(Triangles& some, const Piece& of, std::vector<Piece>& parts) {
    for (const std::uint32_t t : some) seen_[t] = 1;
    for (const std::uint32_t t : some)
      for (std::uint32_t& other : across_[t])
        if (other != kNoTriangle && !seen_[other]) {
          for (std::uint32_t& back : across_[other])
            if (back == t) back = kNoTriangle;
          other = kNoTriangle;
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
      if (!is_long) found = inspect_chart(result_, across_, chart, texels);
      const double all = (chart.width + 2.0) * (chart.height + 2.0);
      if (texels.size() > 1 &&
          (is_long || !found.to_part.empty() || (all > kSmall && static_cast<double>(found.used) < kFull * all))) {
        std::array<Triangles, 2> order;
        ChartCut c = best_cut(texels, found.to_part, is_long, order);
        // Peeling a few triangles off a large piece, and again, would take forever.
        if (const std::size_t less = std::min(c.first, texels.size() - c.first);
            texels.size() > kMany && kUneven * less < texels.size())
          c = best_cut(texels, found.to_part, true, order);
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
  double texels_per_metre_;
  TrianglesAcross across_;
  std::vector<Vec3> normal_;  ///< unit; zero where a triangle has no area
  std::vector<double> area_;
  std::vector<std::uint8_t> seen_;  ///< scratch; each piece writes at its own triangles
};

}  // namespace

std::vector<AtlasChart> find_charts(const WrittenResult& result, double texels_per_metre, const Monitor& monitor) {
  return ChartFinder(result, texels_per_metre).charts(monitor);
}

}  // namespace clerestory
