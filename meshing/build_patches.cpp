#include "meshing/build_patches.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "meshing/clean.h"
#include "meshing/find_outlines.h"
#include "meshing/imprint_contacts.h"
#include "meshing/planar_regions.h"
#include "meshing/plane_groups.h"
#include "meshing/simplify.h"
#include "meshing/subdivide.h"
#include "meshing/triangle_quality.h"
#include "solver/model/box.h"
#include "solver/model/error.h"
#include "solver/model/triangle_size.h"

namespace clerestory {
namespace {

constexpr double kMostTriangles = 20e6;

double total_area(const FaceComplex& complex) {
  double area = 0;
  for (const Face& f : complex.faces) {
    const Vec3 a = complex.vertices[f.corner[0]];
    area += length(cross(complex.vertices[f.corner[1]] - a, complex.vertices[f.corner[2]] - a)) / 2;
  }
  return area;
}

/// Area alone decides, so that the choice scales.
double default_element(const FaceComplex& complex, const MeshOptions& options) {
  return longest_edge_for(std::max(1.0, options.target_triangles), total_area(complex));
}

/// The bound on edges that was asked for, in the working frame.
double asked_element(const Scene& scene, const FaceComplex& complex, const MeshOptions& options) {
  if (!options.max_element) return default_element(complex, options);
  if (!(*options.max_element > 0) || !std::isfinite(*options.max_element)) {
    char text[160];
    std::snprintf(text, sizeof text, ": max_element = %g m is not a length; give one above 0, such as 0.5.",
                  *options.max_element);
    throw InputError(scene.file + text);
  }
  return *options.max_element / complex.size;
}

/// How far simplification may move a surface, in the working frame: a 64th of the smallest elements, those that are
/// halved three times. That longer ones were asked for makes nothing of the model less visible.
double detail_of(const Scene& scene, const FaceComplex& complex, const MeshOptions& options) {
  if (options.detail) return *options.detail / complex.size;
  return std::min(asked_element(scene, complex, options), default_element(complex, options)) / 512;
}

/// The one that is in force.
double longest_element(const Scene& scene, const FaceComplex& complex, const std::vector<PlanarDomain>& domains,
                       const MeshOptions& options) {
  double longest = asked_element(scene, complex, options);
  const double area = total_area(complex);
  const double count = estimate_triangles(complex, domains, area, longest);
  if (options.max_element && !options.fit_triangles && count > kMostTriangles) {
    double enough = longest;
    while (estimate_triangles(complex, domains, area, enough) > kMostTriangles && enough < 2) enough *= 1.1;
    char text[240];
    std::snprintf(
        text, sizeof text,
        ": max_element = %g m would give about %.3g million triangles, more than the limit of %g million; set "
        "max_element to %.2g m or more.",
        *options.max_element, count / 1e6, kMostTriangles / 1e6, enough * complex.size);
    throw InputError(scene.file + text);
  }
  if (!options.fit_triangles) return longest;
  const double most = std::min(kMostTriangles, *options.fit_triangles);
  while (longest < 2 && estimate_triangles(complex, domains, area, longest) > most) longest *= 1.1;
  return longest;
}

PatchSet to_patches(const Scene& scene, const FaceComplex& complex, const std::vector<MeshTriangle>& triangles) {
  PatchSet patches;
  patches.origin = complex.origin;
  patches.channels = scene.channels();
  patches.materials = scene.materials;
  patches.surfaces = scene.surfaces;
  std::vector<VertexId> place(complex.vertices.size());
  for (const MeshTriangle& t : triangles)
    for (const std::uint32_t v : t.corner) place[v] = VertexId{std::size_t{0}};
  for (std::size_t v = 0; v < place.size(); ++v) {
    if (!place[v].valid()) continue;
    place[v] = VertexId{patches.vertices.size()};
    patches.vertices.push_back(complex.vertices[v] * complex.size);
  }
  for (const MeshTriangle& t : triangles) {
    patches.corners.push_back({place[t.corner[0]], place[t.corner[1]], place[t.corner[2]]});
    patches.side_material.push_back({t.sheet.material_above, t.sheet.material_below});
    patches.side_surface.push_back({t.sheet.surface_above, t.sheet.surface_below});
    patches.joined.push_back(t.sheet.joined);
    patches.outlines.push_back(t.outlines);
  }
  if (std::ranges::all_of(patches.outlines, [](const auto& o) { return o[kFront] == 0 && o[kBack] == 0; }))
    patches.outlines = {};
  make_patches(patches, std::vector<bool>(2 * triangles.size(), true));
  return patches;
}

}  // namespace

MeshedScene build_patches(const Scene& scene, const MeshOptions& options, const Monitor& monitor) {
  MeshedScene result;
  MeshReport& report = result.report;
  FaceComplex complex;
  std::vector<PlaneGroup> groups;
  Drawing drawing;
  for (const Tolerance& allowed : kTolerances) {
    report = {};
    complex = clean(scene, allowed, report);
    simplify(complex, scene.materials, detail_of(scene, complex, options), report, monitor);
    count_edges(complex, report);
    groups = group_by_plane(complex);
    const std::vector<Outline> outlines =
        find_outlines(complex, groups, scene.materials, asked_element(scene, complex, options));
    drawing = imprint_contacts(complex, groups, outlines, report);
    report.tolerance = allowed.contact * complex.size;
    if (drawing.settled) break;
  }
  const std::vector<PlanarDomain> domains =
      join_planar_regions(complex, groups, scene.materials, std::move(drawing), report);
  const double longest = longest_element(scene, complex, domains, options);
  const std::vector<MeshTriangle> triangles =
      subdivide(complex, groups, scene.materials, domains, longest, report, monitor);
  result.patches = to_patches(scene, complex, triangles);
  report.max_element = longest * complex.size;
  measure_quality(result.patches, report);
  return result;
}

}  // namespace clerestory
