#include "solver/openings/openings.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>

#include "solver/form_factors/point_to_polygon.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/sampling/unit_square.h"

namespace clerestory {

double way_out(const LightArea& opening, const Vec3& p, const Vec3& d) {
  if (!OpeningSphere(opening).is_passed(p, d)) return -1;
  const double t = dot(p - opening.centre, opening.normal) / -dot(d, opening.normal);
  if (!(t > 0)) return -1;
  const Vec3 x = p + d * t;
  for (const auto& [a, b, c] : opening.triangles) {
    const double ab = dot(cross(b - a, x - a), opening.normal), bc = dot(cross(c - b, x - b), opening.normal),
                 ca = dot(cross(a - c, x - c), opening.normal);
    if (ab >= 0 && bc >= 0 && ca >= 0) return t;
  }
  return -1;
}

bool is_passed(const LightArea& opening, const Vec3& p, const Vec3& d, double distance) {
  const double out = way_out(opening, p, d);
  if (out >= 0) return out <= distance;
  const Vec3 towards = opening.centre - p;
  if (!(dot(d, opening.normal) > 0) || !(dot(towards, opening.normal) > 0)) return false;  // not from behind it
  const double beyond = dot(towards, d) + 2 * opening.radius;
  const double in = way_out(opening, p + d * beyond, -d);
  return in >= 0 && beyond - in >= 0 && beyond - in <= distance;
}

std::uint32_t first_way_out(std::span<const LightArea> openings, std::span<const std::uint32_t> numbers, const Vec3& p,
                            const Vec3& d, double distance) {
  for (const std::uint32_t k : numbers) {
    const double out = way_out(openings[k], p, d);
    if (out >= 0 && out <= distance) return k;
  }
  return kNoOpening;
}

bool sees_much_sky(std::span<const Hit> hits) {
  constexpr double kMuch = 0.3;
  return static_cast<double>(std::ranges::count_if(hits, &Hit::escaped)) > kMuch * static_cast<double>(hits.size());
}

double most_it_gives(const LightArea& opening, const Vec3& p, const Vec3& n) {
  const Vec3 d = opening.centre - p;
  const double height = -dot(d, opening.normal), above = dot(d, n) + opening.radius;
  if (!(height > 0) || !(above > 0)) return 0;
  const double r = length(d), nearest = r - opening.radius;
  if (nearest < opening.radius) return 1;
  const double cos_p = std::min(1.0, above / nearest), cos_o = std::min(1.0, height / nearest);
  return opening.area * cos_p * cos_o / (std::numbers::pi * nearest * nearest);
}

double form_factor(const LightArea& opening, const Vec3& p, const Vec3& n) {
  double F = 0;
  for (const auto& triangle : opening.triangles) F += point_to_polygon(p, n, triangle);
  return F;
}

bool is_slit(const LightArea& opening) {
  constexpr double kNarrow = 0.02;  // of its length: windows are wider
  return opening.area < kNarrow * 4 * opening.radius * opening.radius;
}

std::vector<LightArea> slits_among(std::span<const LightArea> openings) {
  std::vector<LightArea> slits;
  std::ranges::copy_if(openings, std::back_inserter(slits), is_slit);
  return slits;
}

namespace {

/// The triangle where the running sum of areas passes `left`, which becomes what is left in it [m2].
const std::array<Vec3, 3>& triangle_at(const LightArea& opening, double& left) {
  for (const auto& triangle : opening.triangles) {
    const double area = length(cross(triangle[1] - triangle[0], triangle[2] - triangle[0])) / 2;
    if (left < area) return triangle;
    left -= area;
  }
  return opening.triangles.back();  // by rounding
}

}  // namespace

Vec3 point_of(const LightArea& opening, double u, double v) {
  double left = u * opening.area;
  const auto& triangle = triangle_at(opening, left);
  const double area = length(cross(triangle[1] - triangle[0], triangle[2] - triangle[0])) / 2;
  return point_on_triangle(triangle, std::min(left / area, 1.0), v);
}

Ray ray_through(const LightArea& opening, const Vec3& side, std::uint64_t key, std::uint32_t k, double lift) {
  const auto u = sobol4(k, key);
  double left = sobol4(k, key + 1)[0] * opening.area;
  const auto& triangle = triangle_at(opening, left);
  // A little short of what is around: rounding would put the start behind it.
  const double inset = std::min(0.05, lift * 2 * opening.radius / opening.area);
  const Vec3 p = point_on_triangle(triangle, u[0], u[1]);
  return {p + (opening.centre - p) * inset + side * lift, cosine_direction(Frame(side), u[2], u[3])};
}

namespace {

/// Form factor, roughly but for slits and from nearby: as of discs around three points of each triangle; from afar
/// around the centre.
double about_form_factor(const LightArea& opening, const Vec3& p, const Vec3& n) {
  const Vec3 to_centre = opening.centre - p;
  const double height = -dot(to_centre, opening.normal), above = dot(to_centre, n), r2 = dot(to_centre, to_centre);
  if (!(height > 0)) return 0;
  const auto disc = [&](double area, double above_horizon, double square) {
    return area * std::max(0.0, above_horizon) * height / (square * (std::numbers::pi * square + area));
  };
  constexpr double kNear = 1.5, kAfar = 4;  // radii; from afar 2 % off at most where all of it is in view
  if (r2 > kAfar * kAfar * opening.radius * opening.radius && std::abs(above) > opening.radius)
    return disc(opening.area, above, r2);
  if (r2 < kNear * kNear * opening.radius * opening.radius || is_slit(opening)) return form_factor(opening, p, n);
  double F = 0;
  for (const auto& [a, b, c] : opening.triangles) {
    const double area = length(cross(b - a, c - a)) / 2;
    const Vec3 middle = (a + b + c) / 6 - p;
    for (const Vec3& corner : {a, b, c}) {
      const Vec3 d = middle + corner / 2;
      F += disc(area / 3, dot(d, n), dot(d, d));
    }
  }
  return F;
}

/// Areas one after another, those that give most first. Form factors cost more than all the rest: they are found for
/// what may give more than the best that is known.
class AreasByLight {
 public:
  AreasByLight(std::span<const LightArea> areas, const Vec3& p, const Vec3& n) : areas_(areas), p_(p), n_(n) {
    for (std::uint32_t k = 0; k < areas.size(); ++k) {
      if (areas[k].reach && !areas[k].reach->contains(p)) continue;
      if (const double bound = most_it_gives(areas[k], p, n); bound > kNothing)
        heap_.push_back({{bound * areas[k].brightness, k}, false});
    }
    std::make_heap(heap_.begin(), heap_.end(), is_after);
  }

  std::optional<AreaOver> next() {
    while (!heap_.empty()) {
      std::pop_heap(heap_.begin(), heap_.end(), is_after);
      if (heap_.back().is_known) {
        const AreaOver found = heap_.back().area;
        heap_.pop_back();
        return found;
      }
      const std::uint32_t k = heap_.back().area.number;
      const double F = about_form_factor(areas_[k], p_, n_);
      if (F > kNothing) {
        heap_.back() = {{F * areas_[k].brightness, k}, true};
        std::push_heap(heap_.begin(), heap_.end(), is_after);
      } else {
        heap_.pop_back();
      }
    }
    return std::nullopt;
  }

 private:
  static constexpr double kNothing = 1e-9;
  struct Entry {
    AreaOver area;  ///< as long as it is not known, what it may give at most
    bool is_known;
  };
  static bool is_after(const Entry& a, const Entry& b) {
    return a.area.gives != b.area.gives ? a.area.gives < b.area.gives : a.area.number > b.area.number;
  }

  std::span<const LightArea> areas_;
  Vec3 p_, n_;
  std::vector<Entry> heap_;
};

/// Share of an area that is seen [1]: of segments between 16 points that look and points all over it.
double share_in_view(const RayScene& scene, const LightArea& area, const Vec3& n,
                     const std::function<Vec3(std::uint32_t)>& from) {
  constexpr std::uint32_t kSegments = 16;
  SegmentPacket packet;
  unsigned active = 0;
  for (std::uint32_t k = 0; k < kSegments; ++k) {
    const auto u = sobol4(k, kAreasInView);
    const Vec3 p = from(k), q = point_of(area, u[0], u[1]);
    if (!(dot(q - p, n) > 0) || !(dot(p - q, area.normal) > 0)) continue;
    packet.set(static_cast<int>(k), p, q + area.normal * scene.lift());
    active |= 1u << k;
  }
  if (active == 0) return 0;
  return std::popcount(scene.visible16(packet, static_cast<std::uint16_t>(active))) / static_cast<double>(kSegments);
}

}  // namespace

std::vector<AreaOver> areas_over(std::span<const LightArea> areas, const Vec3& p, const Vec3& n, std::size_t most) {
  std::vector<AreaOver> found;
  AreasByLight by_light(areas, p, n);
  while (found.size() < most)
    if (const auto next = by_light.next())
      found.push_back(*next);
    else
      break;
  return found;
}

std::vector<std::uint32_t> areas_in_view(const RayScene& scene, std::span<const LightArea> areas, const Vec3& p,
                                         const Vec3& n, const std::function<Vec3(std::uint32_t)>& from,
                                         const AreasWanted& wanted, unsigned long long& rays) {
  constexpr std::size_t kMostTried = 64;
  std::vector<AreaOver> found;  // by what is in view of them, the most first
  AreasByLight by_light(areas, p, n);
  for (std::size_t tried = 0; tried < kMostTried; ++tried) {
    const auto next = by_light.next();
    if (!next) break;
    if (!found.empty() && next->gives < wanted.least_of_best * found.front().gives) break;
    if (found.size() == wanted.most && next->gives <= found.back().gives) break;
    const double gives = next->gives * share_in_view(scene, areas[next->number], n, from);
    rays += 16;
    if (!(gives > 0)) continue;
    const auto after = [](double x, const AreaOver& area) { return x > area.gives; };
    found.insert(std::upper_bound(found.begin(), found.end(), gives, after), {gives, next->number});
    if (found.size() > wanted.most) found.pop_back();
  }
  std::vector<std::uint32_t> numbers;
  for (const AreaOver& area : found)
    if (area.gives >= wanted.least_of_best * found.front().gives) numbers.push_back(area.number);
  std::ranges::sort(numbers);
  return numbers;
}

}  // namespace clerestory
