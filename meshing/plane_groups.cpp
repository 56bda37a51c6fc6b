#include "meshing/plane_groups.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <span>

#include "solver/model/box_tree.h"
#include "solver/model/parallel.h"

namespace clerestory {
namespace {

struct FaceShape {
  Vec3 centre, normal;
  double area, longest, height;  ///< height: of the triangle over its longest edge
  double slack;                  ///< most that the normal may be off its plane's [sine]
};

FaceShape shape_of(const FaceComplex& complex, const Face& face) {
  const Vec3 a = complex.vertices[face.corner[0]], b = complex.vertices[face.corner[1]],
             c = complex.vertices[face.corner[2]];
  const Vec3 n = cross(b - a, c - a);
  const double longest = std::max({length(b - a), length(c - b), length(a - c)});
  const double height = length(n) / longest;
  // Corners' rounding turns the normal of a low triangle by about tolerance / height.
  const double tolerance = std::min(complex.allowed.contact, complex.allowed.local_share * longest);
  return {(a + b + c) / 3, normalized(n), length(n) / 2, longest, height, 0.01 + 2 * tolerance / height};
}

bool lies_in(const Plane& plane, const FaceComplex& complex, const Face& face, const FaceShape& shape, double drift) {
  const double tolerance = std::min(complex.allowed.contact, complex.allowed.local_share * shape.longest);
  for (const std::uint32_t v : face.corner) {
    const Vec3& p = complex.vertices[v];
    if (std::abs(plane.distance(p)) > tolerance + drift * length(p - plane.origin)) return false;
  }
  return length(cross(plane.n, shape.normal)) <= shape.slack;
}

/// The plane nearest to the corners of some faces, by least squares weighted with their area: z = c0 + c1 x + c2 y in
/// the frame of the plane that is about right.
Plane fit(const Plane& about, const FaceComplex& complex, const std::vector<FaceShape>& shapes,
          const std::vector<std::uint32_t>& faces) {
  Vec3 centre;
  double weight = 0;
  for (const std::uint32_t f : faces) {
    centre += shapes[f].centre * shapes[f].area;
    weight += shapes[f].area;
  }
  centre = centre / weight;
  double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0, z0 = 0;
  for (const std::uint32_t f : faces)
    for (const std::uint32_t v : complex.faces[f].corner) {
      const Vec3 d = complex.vertices[v] - centre;
      const double w = shapes[f].area, x = dot(d, about.t), y = dot(d, about.b), z = dot(d, about.n);
      xx += w * x * x;
      xy += w * x * y;
      yy += w * y * y;
      xz += w * x * z;
      yz += w * y * z;
      z0 += w * z;  // x and y have no mean: centroids are at the mean of their corners
    }
  const double det = xx * yy - xy * xy;
  if (!(det > 1e-12 * xx * yy)) return about;
  const double c1 = (xz * yy - yz * xy) / det, c2 = (yz * xx - xz * xy) / det;
  const Frame frame(normalized(about.n - about.t * c1 - about.b * c2));
  return {centre + about.n * (z0 / (3 * weight)), frame.t, frame.b, frame.n};
}

/// For each face those whose boxes touch its own and that may lie in one plane with it. Of a face that touches very
/// many only those are found that no group has taken yet, when they are asked for: many faces on each other are then
/// met once and not once by each of them.
class Neighbours {
 public:
  Neighbours(const FaceComplex& complex, const std::vector<FaceShape>& shapes)
      : complex_(complex), shapes_(shapes), tree_(shapes.size(), BoxOfFace{&complex, &shapes}), place_(shapes.size()) {
    const std::size_t count = shapes.size();
    found_.resize((count + kGrain - 1) / kGrain);
    parallel_for(found_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t chunk = begin; chunk < end; ++chunk)
        for (std::size_t k = chunk * kGrain; k < std::min(count, (chunk + 1) * kGrain); ++k) {
          const std::uint32_t f = tree_.order()[k];
          auto& found = found_[chunk];
          const auto first = static_cast<std::uint32_t>(found.size());
          const Box around = tree_.box(f);
          std::size_t met = 0;
          tree_.visit_if([&](const Box& b) { return met <= kMany && b.touches(around); },
                         [&](std::uint32_t g) {
                           ++met;
                           if (may_share_plane(f, g)) found.push_back(g);
                         });
          if (met > kMany) found.resize(first);
          std::sort(found.begin() + first, found.end());
          place_[f] = {static_cast<std::uint32_t>(chunk), first,
                       met > kMany ? kCrowded : static_cast<std::uint32_t>(found.size() - first)};
        }
    });
    if (std::ranges::none_of(place_, [](const Place& p) { return p.count == kCrowded; })) return;
    free_ = tree_.by_node([](std::uint32_t) { return std::uint32_t{1}; }, std::plus<>());
    in_order_.resize(count);
    for (std::uint32_t k = 0; k < count; ++k) in_order_[tree_.order()[k]] = k;
  }

  /// In ascending order; valid until the next call. Some may be taken.
  std::span<const std::uint32_t> of(std::uint32_t f, const std::vector<bool>& taken) {
    if (place_[f].count != kCrowded)
      return std::span(found_[place_[f].chunk]).subspan(place_[f].first, place_[f].count);
    asked_.clear();
    const Box around = tree_.box(f);
    tree_.visit_if([&](const Box& b) { return b.touches(around); },
                   [&](std::uint32_t g) {
                     ++met_;
                     if (!taken[g] && may_share_plane(f, g)) asked_.push_back(g);
                   },
                   [&](std::size_t node) { return free_[node] > 0; });
    CrowdLimit{"pairs of faces touch by their boxes", 20'000'000 + 500 * shapes_.size()}.check(met_, complex_);
    std::sort(asked_.begin(), asked_.end());
    return asked_;
  }
  /// To be told of all that a group takes or gives back.
  void take(std::uint32_t f) {
    if (!free_.empty()) tree_.visit_nodes_of(in_order_[f], [&](std::size_t node) { --free_[node]; });
  }
  void give_back(std::uint32_t f) {
    if (!free_.empty()) tree_.visit_nodes_of(in_order_[f], [&](std::size_t node) { ++free_[node]; });
  }

 private:
  static constexpr std::size_t kGrain = 1024, kMany = 256;
  static constexpr std::uint32_t kCrowded = 0xffffffff;
  struct Place {
    std::uint32_t chunk, first, count;
  };
  struct BoxOfFace {
    const FaceComplex* complex;
    const std::vector<FaceShape>* shapes;
    Box operator()(std::uint32_t f) const {
      Box box;
      for (const std::uint32_t v : complex->faces[f].corner) box.add(complex->vertices[v]);
      return box.grown(std::min(complex->allowed.contact, complex->allowed.local_share * (*shapes)[f].longest));
    }
  };
  bool may_share_plane(std::uint32_t f, std::uint32_t g) const {
    return g != f && length(cross(shapes_[f].normal, shapes_[g].normal)) <= shapes_[f].slack + shapes_[g].slack;
  }

  const FaceComplex& complex_;
  const std::vector<FaceShape>& shapes_;
  BoxTree<BoxOfFace> tree_;
  std::vector<Place> place_;
  std::vector<std::vector<std::uint32_t>> found_;
  std::vector<std::uint32_t> free_;      // by node, of its faces those not taken; empty where no face is crowded
  std::vector<std::uint32_t> in_order_;  // by face, its place in the tree's order
  std::vector<std::uint32_t> asked_;
  std::size_t met_ = 0;
};

}  // namespace

std::vector<PlaneGroup> group_by_plane(const FaceComplex& complex) {
  const std::size_t count = complex.faces.size();
  std::vector<FaceShape> shapes(count);
  parallel_for(count, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) shapes[f] = shape_of(complex, complex.faces[f]);
  });
  Neighbours neighbours(complex, shapes);

  std::vector<std::uint32_t> by_area(count);
  std::iota(by_area.begin(), by_area.end(), 0u);
  std::sort(by_area.begin(), by_area.end(), [&](std::uint32_t i, std::uint32_t j) {
    return shapes[i].area != shapes[j].area ? shapes[i].area > shapes[j].area : i < j;
  });

  std::vector<PlaneGroup> groups;
  std::vector<bool> placed(count);
  const auto grow = [&](std::uint32_t seed, const Plane& plane, double drift) {
    std::vector<std::uint32_t> faces;
    const auto place = [&](std::uint32_t f) {
      placed[f] = true;
      neighbours.take(f);
      faces.push_back(f);
    };
    place(seed);
    for (std::size_t k = 0; k < faces.size(); ++k)
      for (const std::uint32_t f : neighbours.of(faces[k], placed))
        if (!placed[f] && lies_in(plane, complex, complex.faces[f], shapes[f], drift)) place(f);
    return faces;
  };
  for (const std::uint32_t seed : by_area) {
    if (placed[seed]) continue;
    const Frame frame(shapes[seed].normal);
    PlaneGroup group{{shapes[seed].centre, frame.t, frame.b, frame.n}, {}};
    // What lies in the seed's plane by a tolerance that grows with the distance, as the seed's own rounding does ...
    constexpr double kDrift = 5e-6;
    group.faces = grow(seed, group.plane, kDrift);
    const Plane fitted = fit(group.plane, complex, shapes, group.faces);
    const auto fits = [&](std::uint32_t f) { return lies_in(fitted, complex, complex.faces[f], shapes[f], 0); };
    // ... and then strictly in the plane that fits all of that, unless it is not the seed's any more.
    if (fits(seed)) group.plane = fitted;
    if (!fits(seed) || !std::all_of(group.faces.begin(), group.faces.end(), fits)) {
      for (const std::uint32_t f : group.faces) {
        placed[f] = false;
        neighbours.give_back(f);
      }
      group.faces = grow(seed, group.plane, 0);
    }
    std::sort(group.faces.begin(), group.faces.end());
    groups.push_back(std::move(group));
  }
  return groups;
}

}  // namespace clerestory
