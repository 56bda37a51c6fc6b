#include "meshing/plane_groups.h"

#include <algorithm>
#include <numeric>

#include "meshing/box_tree.h"

namespace clerestory {
namespace {

struct FaceShape {
  Vec3 centre, normal;
  double area, longest, height;  ///< height: of the triangle over its longest edge
};

FaceShape shape_of(const FaceComplex& complex, const Face& face) {
  const Vec3 a = complex.vertices[face.corner[0]], b = complex.vertices[face.corner[1]],
             c = complex.vertices[face.corner[2]];
  const Vec3 n = cross(b - a, c - a);
  const double longest = std::max({length(b - a), length(c - b), length(a - c)});
  return {(a + b + c) / 3, normalized(n), length(n) / 2, longest, length(n) / longest};
}

bool lies_in(const Plane& plane, const FaceComplex& complex, const Face& face, const FaceShape& shape) {
  // A plane is known less well far from the face that gave it.
  const double tolerance = std::min(kContact, kLocalShare * shape.longest);
  for (const std::uint32_t v : face.corner) {
    const Vec3& p = complex.vertices[v];
    if (std::abs(plane.distance(p)) > tolerance + 5e-6 * length(p - plane.origin)) return false;
  }
  // The corners' rounding turns the normal of a low triangle by about tolerance / height.
  return length(cross(plane.n, shape.normal)) <= 0.01 + 2 * tolerance / shape.height;
}

}  // namespace

std::vector<PlaneGroup> group_by_plane(const FaceComplex& complex) {
  const std::size_t count = complex.faces.size();
  std::vector<FaceShape> shapes(count);
  std::vector<Box> boxes(count);
  for (std::size_t f = 0; f < count; ++f) {
    shapes[f] = shape_of(complex, complex.faces[f]);
    for (const std::uint32_t v : complex.faces[f].corner) boxes[f].add(complex.vertices[v]);
    boxes[f] = boxes[f].grown(std::min(kContact, kLocalShare * shapes[f].longest));
  }
  const BoxTree tree(boxes);

  std::vector<std::uint32_t> by_area(count);
  std::iota(by_area.begin(), by_area.end(), 0u);
  std::sort(by_area.begin(), by_area.end(), [&](std::uint32_t i, std::uint32_t j) {
    return shapes[i].area != shapes[j].area ? shapes[i].area > shapes[j].area : i < j;
  });

  std::vector<PlaneGroup> groups;
  std::vector<bool> placed(count);
  for (const std::uint32_t seed : by_area) {
    if (placed[seed]) continue;
    const Frame frame(shapes[seed].normal);
    PlaneGroup group{{shapes[seed].centre, frame.t, frame.b, frame.n}, {seed}};
    placed[seed] = true;
    for (std::size_t k = 0; k < group.faces.size(); ++k) {
      tree.visit(boxes[group.faces[k]], [&](std::uint32_t f) {
        if (placed[f] || !lies_in(group.plane, complex, complex.faces[f], shapes[f])) return;
        placed[f] = true;
        group.faces.push_back(f);
      });
    }
    std::sort(group.faces.begin(), group.faces.end());
    groups.push_back(std::move(group));
  }
  return groups;
}

}  // namespace clerestory
