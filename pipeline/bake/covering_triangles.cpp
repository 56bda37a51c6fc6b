#include "pipeline/bake/covering_triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/geometry/triangle.h"
#include "solver/model/box.h"
#include "solver/model/box_tree.h"
#include "solver/model/parallel.h"

namespace clerestory {
namespace {

using Triangle = std::array<Vec3, 3>;

constexpr std::size_t kGrain = 1024;
/// A triangle whose plane leans more than 60 degrees from a face's does not cover it.
constexpr double kCovers = 0.5;

Box box_of(const Triangle& t) { return Box::around(t); }
Vec3 centroid(const Triangle& t) { return (t[0] + t[1] + t[2]) / 3; }
Vec3 unit_normal(const Triangle& t) { return normalized(cross(t[1] - t[0], t[2] - t[0])); }

/// Weights of the corners of t for the point x in it.
std::array<float, 3> weights(const Triangle& t, const Vec3& x) {
  const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
  const double nn = dot(n, n);
  if (!(nn > 0)) return {1, 0, 0};
  const double v = std::clamp(dot(cross(t[2] - x, t[0] - x), n) / nn, 0.0, 1.0);
  const double w = std::clamp(dot(cross(t[0] - x, t[1] - x), n) / nn, 0.0, 1.0 - v);
  return {static_cast<float>(1 - v - w), static_cast<float>(v), static_cast<float>(w)};
}

/// Least distance of q, in the triangle, from its edges [m].
double off_rim(const Triangle& t, const Vec3& q) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 edge = t[(k + 1) % 3] - t[k];
    least = std::min(least, length(cross(normalized(edge), q - t[k])));
  }
  return least;
}

double width(const Triangle& t) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, length(t[(k + 1) % 3] - t[k]));
  return longest > 0 ? length(cross(t[1] - t[0], t[2] - t[0])) / longest : 0;
}

class Cover {
 public:
  Cover(const WrittenResult& result, std::span<const Triangle> model)
      : result_(result),
        model_(model),
        lit_count_(result.triangles.size()),
        rounding_(rounding_of(result)),
        tolerance_(rounding_ + moved(result)),
        tree_(lit_count_ + result.around.panes.size(), BoxOf{this}) {}
  Cover(const Cover&) = delete;  // the tree looks here
  Cover& operator=(const Cover&) = delete;

  CoveredModel operator()() {
    CoveredModel covered;
    covered.covering.resize(6 * model_.size());
    find_owners(covered.missing_share);
    parallel_for(model_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f) cover(f, std::span(covered.covering).subspan(6 * f, 6));
    });
    return covered;
  }

 private:
  /// What floats lose, and readers and meshers round [m].
  static double rounding_of(const WrittenResult& result) {
    const Box box = Box::around(result.points);
    return 1e-5 * length(box.upper - box.lower);
  }
  /// Faces that the mesher simplified are so far from where they were, at most.
  static double moved(const WrittenResult& result) {
    const auto by = result.figures.find("repairs.simplified_by");
    return by != result.figures.end() ? by->second : 0;
  }

  /// Of the result, or a pane behind those.
  Triangle triangle(std::uint32_t i) const {
    if (i >= lit_count_) return result_.around.panes[i - lit_count_].corners;
    const auto& [a, b, c] = result_.triangles[i];
    return {result_.points[a], result_.points[b], result_.points[c]};
  }

  /// Of each side of a face the triangles of the result whose middle lies on it.
  void find_owners(double& missing_share) {
    const BoxTree faces(model_.size(), [this](std::uint32_t f) { return box_of(model_[f]); });
    std::vector<std::uint32_t> owner(lit_count_, CornerCover::kNone);
    parallel_for(lit_count_, kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Triangle t = triangle(static_cast<std::uint32_t>(i));
        const Vec3 x = centroid(t), n = unit_normal(t);
        double nearest = tolerance_;
        faces.visit(Box{x, x}.grown(tolerance_), [&](std::uint32_t f) {
          const double away = length(nearest_point(model_[f], x) - x);
          if (away > nearest || (away == nearest && owner[i] < 2 * f)) return;
          const double cosine = dot(unit_normal(model_[f]), n);
          if (std::abs(cosine) < kCovers) return;
          nearest = away;
          owner[i] = 2 * f + (cosine < 0 ? 1 : 0);
        });
      }
    });
    begin_.assign(2 * model_.size() + 1, 0);
    double missing = 0, all = 0;
    for (std::size_t i = 0; i < lit_count_; ++i) {
      const Triangle t = triangle(static_cast<std::uint32_t>(i));
      const double area = length(cross(t[1] - t[0], t[2] - t[0]));
      all += area;
      if (owner[i] == CornerCover::kNone)
        missing += area;
      else
        ++begin_[owner[i] + 1];
    }
    missing_share = all > 0 ? missing / all : 0;
    for (std::size_t s = 1; s < begin_.size(); ++s) begin_[s] += begin_[s - 1];
    on_side_.resize(begin_.back());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t i = 0; i < lit_count_; ++i)
      if (owner[i] != CornerCover::kNone) on_side_[next[owner[i]]++] = static_cast<std::uint32_t>(i);
  }

  struct Found {
    std::uint32_t triangle = CornerCover::kNone;
    double away = std::numeric_limits<double>::infinity();
    /// Of equally near ones the first, as the order of visits is the tree's.
    void take(std::uint32_t i, double d) {
      if (d < away || (d == away && i < triangle)) away = d, triangle = i;
    }
  };

  /// The triangles that lie on the front, on the back, and panes that lie there, at the point q of a face that is
  /// `off_rim` from its edges. What ends beside q belongs to what lies beyond the rim.
  std::array<Found, 3> at(const Vec3& q, const Vec3& normal, double off_rim) const {
    std::array<Found, 3> found;
    tree_.visit(Box{q, q}.grown(tolerance_), [&](std::uint32_t i) {
      const Triangle t = triangle(i);
      const Vec3 d = nearest_point(t, q) - q;
      const double away = length(d);
      if (away > tolerance_) return;
      const Vec3 n = unit_normal(t);
      const double cosine = dot(n, normal), height = std::abs(dot(d, n));
      if (std::abs(cosine) < kCovers) return;
      const double beside = std::sqrt(std::max(0.0, away * away - height * height));
      if (beside > 0.3 * off_rim + height) return;
      found[i >= lit_count_ ? 2 : cosine > 0 ? 0 : 1].take(i, away);
    });
    return found;
  }

  void cover(std::size_t f, std::span<CornerCover> covering) const {
    const Triangle& face = model_[f];
    const Vec3 normal = unit_normal(face), middle = centroid(face);
    if (width(face) < rounding_) std::ranges::fill(covering, CornerCover{CornerCover::kNone, {}, true});
    if (!(length(normal) > 0)) return;
    std::array<std::array<std::uint32_t, 3>, 2> by;
    by[0].fill(CornerCover::kNone), by[1].fill(CornerCover::kNone);
    int panes = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 inwards = middle - face[k];
      const Vec3 q = face[k] + inwards * std::min(0.5, 2 * rounding_ / length(inwards));
      const auto found = at(q, normal, off_rim(face, q));
      for (std::size_t side = 0; side < 2; ++side) by[side][k] = found[side].triangle;
      panes += found[2].triangle != CornerCover::kNone && found[2].away <= std::min(found[0].away, found[1].away);
    }
    if (panes >= 2) {
      std::ranges::fill(covering, CornerCover{CornerCover::kPane, {}, false});
      return;
    }
    for (std::size_t side = 0; side < 2; ++side) {
      const std::array<std::uint32_t, 3> found = by[side];
      fill_gaps(face, 2 * f + side, by[side]);
      for (std::size_t k = 0; k < 3; ++k) {
        if (by[side][k] == CornerCover::kNone) continue;
        const Triangle t = triangle(by[side][k]);
        covering[3 * side + k] = {by[side][k], weights(t, nearest_point(t, face[k])), found[k] == CornerCover::kNone};
      }
    }
  }

  /// Corners that nothing covers take what is nearest of the same side.
  void fill_gaps(const Triangle& face, std::size_t side, std::array<std::uint32_t, 3>& by) const {
    const std::array<std::uint32_t, 3> found = by;
    for (std::size_t k = 0; k < 3; ++k) {
      if (found[k] != CornerCover::kNone) continue;
      Found nearest;
      const auto look = [&](std::uint32_t i) {
        nearest.take(i, length(nearest_point(triangle(i), face[k]) - face[k]));
      };
      for (std::uint32_t s = begin_[side]; s < begin_[side + 1]; ++s) look(on_side_[s]);
      for (const std::uint32_t i : found)
        if (i != CornerCover::kNone) look(i);
      by[k] = nearest.triangle;
    }
  }

  const WrittenResult& result_;
  std::span<const Triangle> model_;
  std::size_t lit_count_;
  double rounding_, tolerance_;  ///< [m]
  struct BoxOf {
    const Cover* cover;
    Box operator()(std::uint32_t i) const { return box_of(cover->triangle(i)); }
  };
  BoxTree<BoxOf> tree_;
  std::vector<std::uint32_t> begin_, on_side_;  ///< by side of a face, 2 a face
};

}  // namespace

CoveredModel cover_model(const WrittenResult& result, std::span<const Triangle> triangles) {
  return Cover(result, triangles)();
}

}  // namespace clerestory
