#include "meshing/clean.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "meshing/point_index.h"
#include "meshing/stacked_faces.h"
#include "meshing/triangulate_polygon.h"
#include "solver/model/box_tree.h"
#include "solver/model/coordinate_grid.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

/// Beyond this squares overflow; no building is there.
bool is_usable(const Vec3& p) { return std::abs(p.x) < 1e100 && std::abs(p.y) < 1e100 && std::abs(p.z) < 1e100; }

double on_grid(double x) { return std::nearbyint(x / kCoordinateGrid) * kCoordinateGrid; }

struct Welder {
  explicit Welder(FaceComplex& c) : complex(c), index(c.vertices, c.allowed.contact) {}
  std::uint32_t operator()(const Vec3& p, double tolerance) {
    const std::uint32_t known = index.find(p, tolerance);
    if (known != PointIndex::kNone) return known;
    const std::uint32_t id = complex.add_vertex(p, complex.allowed.contact);
    index.add(id);
    return id;
  }
  FaceComplex& complex;
  PointIndex index;
};

/// What is between coordinates by chance, in the working frame: models whose coordinates are all of single precision
/// are taken to be rounded to it; all are rounded to the grid.
double rounding_of(const PolygonSoup& soup, const std::vector<bool>& used, double size) {
  constexpr double kGrid = 8 * kCoordinateGrid;
  double largest = 0;
  bool is_single = true;
  for (std::size_t v = 0; v < soup.vertices.size(); ++v) {
    if (!used[v]) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = soup.vertices[v][axis];
      largest = std::max(largest, std::abs(x));
      is_single = is_single && static_cast<double>(static_cast<float>(x)) == x;
    }
  }
  return std::max(kGrid, (is_single ? 0x1p-23 : 0x1p-51) * largest / size);
}

/// Whether a face lies where another with the same corners lies, before welding.
bool is_at_the_same_place(const FaceComplex& complex, const Face& a, const Face& b) {
  const Vec3 n = normalized(cross(complex.vertices[a.corner[1]] - complex.vertices[a.corner[0]],
                                  complex.vertices[a.corner[2]] - complex.vertices[a.corner[0]]));
  const Plane plane{complex.vertices[a.corner[0]], {}, {}, n};
  return gap_between(complex, height_as_read(complex, plane, a), height_as_read(complex, plane, b)) == 0;
}

/// Drops triangles that repeat one of the same material, wound the same way; counts those wound the other way.
void drop_duplicates(FaceComplex& complex, MeshReport& report) {
  struct Key {
    std::array<std::uint32_t, 3> sorted;
    bool odd;  ///< winding, against ascending corners
    std::uint32_t material, face;
    auto operator<=>(const Key&) const = default;
  };
  std::vector<Key> keys;
  for (std::uint32_t f = 0; f < complex.faces.size(); ++f) {
    auto c = complex.faces[f].corner;
    std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
    const bool odd = c[1] > c[2];
    if (odd) std::swap(c[1], c[2]);
    keys.push_back({c, odd, complex.faces[f].material.value, f});
  }
  std::sort(keys.begin(), keys.end());
  std::vector<bool> drop(complex.faces.size());
  for (std::size_t k = 0; k < keys.size();) {
    std::size_t end = k, turned = 0, dropped = 0;
    for (; end < keys.size() && keys[end].sorted == keys[k].sorted; ++end) {
      const bool repeats =
          end > k && keys[end].odd == keys[end - 1].odd && keys[end].material == keys[end - 1].material &&
          is_at_the_same_place(complex, complex.faces[keys[end].face], complex.faces[keys[end - 1].face]);
      if (repeats) {
        drop[keys[end].face] = true;
        ++dropped;
      } else if (keys[end].odd) {
        ++turned;
      }
    }
    report.duplicate_faces += dropped;
    report.opposite_faces += std::min(turned, end - k - dropped - turned);
    k = end;
  }
  std::size_t kept = 0;
  for (std::size_t f = 0; f < complex.faces.size(); ++f)
    if (!drop[f]) complex.faces[kept++] = complex.faces[f];
  complex.faces.resize(kept);
}

}  // namespace

FaceComplex clean(const Scene& scene, const Tolerance& allowed, MeshReport& report) {
  const PolygonSoup& soup = scene.polygons;
  const std::size_t face_count = soup.face_count();
  report.input_faces = face_count;
  const auto corners_of = [&](std::size_t f) {
    return std::span(soup.corner).subspan(soup.face_begin[f], soup.face_begin[f + 1] - soup.face_begin[f]);
  };

  std::vector<bool> usable(face_count), used_vertex(soup.vertices.size());
  Box extent;
  for (std::size_t f = 0; f < face_count; ++f) {
    const auto corners = corners_of(f);
    usable[f] =
        std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return is_usable(soup.vertices[v]); });
    if (!usable[f])
      ++report.non_finite_faces;
    else
      for (const std::uint32_t v : corners) extent.add(soup.vertices[v]), used_vertex[v] = true;
  }

  FaceComplex complex;
  complex.file = scene.file;
  complex.allowed = allowed;
  if (extent.lower.x <= extent.upper.x) {
    report.lower = extent.lower;
    report.upper = extent.upper;
    complex.origin = (extent.lower + extent.upper) / 2;
    complex.size = length(extent.upper - extent.lower);
  }
  const bool has_size = complex.size > 0 && std::isfinite(complex.size);
  if (!has_size) complex.size = 1;
  complex.rounding = rounding_of(soup, used_vertex, complex.size);

  // Vertices that hang on small faces weld with a small tolerance.
  std::vector<Vec3> local(soup.vertices.size());
  std::vector<double> tolerance(soup.vertices.size(), allowed.contact);
  for (std::size_t f = 0; f < face_count; ++f) {
    if (!usable[f]) continue;
    Box box;
    for (const std::uint32_t v : corners_of(f)) {
      const Vec3 p = (soup.vertices[v] - complex.origin) / complex.size;
      local[v] = {on_grid(p.x), on_grid(p.y), on_grid(p.z)};
      box.add(local[v]);
    }
    // A face that is itself a point says nothing about the detail around it.
    const double extent_of_face = length(box.upper - box.lower);
    if (extent_of_face <= 1e-9) continue;
    for (const std::uint32_t v : corners_of(f))
      tolerance[v] = std::min(tolerance[v], complex.allowed.local_share * extent_of_face);
  }

  Welder weld(complex);
  std::vector<std::uint32_t> welded(soup.vertices.size(), PointIndex::kNone);
  // A polygon of n corners may cross itself n2 / 2 times, and each place becomes a vertex.
  const std::size_t most_crossings = 50'000 + soup.corner.size() / 4;
  std::size_t used = 0, crossings = 0;
  std::vector<Vec3> polygon;
  std::vector<std::uint32_t> ids, read_at;
  for (std::size_t f = 0; f < face_count && has_size; ++f) {
    if (!usable[f]) continue;
    ids.clear();
    read_at.clear();
    polygon.clear();
    for (const std::uint32_t v : corners_of(f)) {
      if (welded[v] == PointIndex::kNone) {
        welded[v] = weld(local[v], tolerance[v]);
        ++used;
      }
      if (!ids.empty() && ids.back() == welded[v]) continue;
      ids.push_back(welded[v]);
      read_at.push_back(v);
    }
    while (ids.size() > 1 && ids.back() == ids.front()) ids.pop_back(), read_at.pop_back();
    for (const std::uint32_t v : ids) polygon.push_back(complex.vertices[v]);
    const PolygonTriangles pieces = triangulate_polygon(polygon, most_crossings - crossings);
    crossings += pieces.crossings.size();
    if (pieces.gave_up)
      throw InputError(scene.file + ": face " + std::to_string(f) + " (from 0), of '" +
                       scene.surfaces[soup.surface[f]] + "', with " + std::to_string(polygon.size()) +
                       " corners crosses itself; with it polygons of the model cross themselves in more than " +
                       std::to_string(most_crossings) +
                       " places, the most for its size. Draw it as polygons that do not, or as triangles.");
    for (const Vec3& p : pieces.crossings) {
      ids.push_back(weld(p, allowed.contact));
      read_at.push_back(Face::kNone);
    }
    bool any = false;
    for (const auto& t : pieces.triangles) {
      const std::array<std::uint32_t, 3> corner{ids[t[0]], ids[t[1]], ids[t[2]]};
      const Face face{corner, soup.material[f], soup.surface[f], {read_at[t[0]], read_at[t[1]], read_at[t[2]]}};
      if (complex.has_area(corner)) {
        complex.faces.push_back(face);
        any = true;
      } else if (corner[0] != corner[1] && corner[1] != corner[2] && corner[2] != corner[0]) {
        complex.flat.push_back(face);
      }
    }
    report.input_triangles += pieces.triangles.size();
    if (!any) ++report.degenerate_faces;
  }
  if (!has_size) report.degenerate_faces = face_count - report.non_finite_faces;
  report.welded_vertices = used > complex.vertices.size() ? used - complex.vertices.size() : 0;

  complex.before_welding = std::move(local);

  if (complex.faces.empty())
    throw InputError(scene.file + ": no face with an area is left of " + std::to_string(face_count) + " read (" +
                     std::to_string(report.non_finite_faces) + " with coordinates that are not finite, " +
                     std::to_string(report.degenerate_faces) +
                     " without area); give a model with surfaces, and check that its export includes meshes.");
  drop_duplicates(complex, report);
  for (const Face& f : complex.faces) {
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(longest, length(complex.vertices[f.corner[(k + 1) % 3]] - complex.vertices[f.corner[k]]));
    for (const std::uint32_t v : f.corner)
      complex.tolerance[v] = std::min(complex.tolerance[v], complex.allowed.local_share * longest);
  }
  return complex;
}

}  // namespace clerestory
