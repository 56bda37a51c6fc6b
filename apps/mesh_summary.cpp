#include "apps/mesh_summary.h"

#include "pipeline/wording.h"

namespace clerestory {
namespace {

std::string point(const Vec3& p) {
  return "(" + rounded(p.x, 4) + ", " + rounded(p.y, 4) + ", " + rounded(p.z, 4) + ")";
}

}  // namespace

void say_mesh(const MeshReport& r, Console& console) {
  const Vec3 size = r.upper - r.lower;
  console.say("  extent   " + rounded(size.x) + " x " + rounded(size.y) + " x " + rounded(size.z) + " m, from " +
              point(r.lower) + " to " + point(r.upper));
  console.say("  read     " + counted(r.input_faces, "face") + " (" + counted(r.input_triangles, "triangle") + ")");
  const auto repair = [&](std::size_t n, const std::string& what) {
    if (n) console.say("  repair   " + what + ": " + grouped(n));
  };
  repair(r.welded_vertices, "vertices welded to another");
  repair(r.non_finite_faces, "faces dropped, a corner is not a number");
  repair(r.degenerate_faces, "faces without area dropped");
  repair(r.duplicate_faces, "faces stored twice dropped");
  repair(r.opposite_faces, "faces stored with both orientations joined to one");
  repair(r.overlapping_regions, "overlapping coplanar surfaces cut apart");
  repair(r.t_junctions, "vertices inside another face's edge shared with it");
  repair(r.imprinted_contacts, "lines where surfaces touch or cross made edges of both");
  repair(r.imprinted_outlines, "lines where something ends just off a surface made edges of it");
  if (r.simplified_parts)
    console.say("  detail   " + counted(r.simplified_faces, "face") + " of " + counted(r.simplified_parts, "part") +
                " merged with others, which moved no surface by more than " + rounded(1000 * r.simplified_by) + " mm");
  if (r.boundary_edges || r.non_manifold_edges)
    console.say("  edges    " + grouped(r.boundary_edges) + " of one face, " + grouped(r.non_manifold_edges) +
                " of more than two (no defects by themselves)");
  console.say("  mesh     " + counted(r.triangles, "triangle") + " from " + counted(r.planar_regions, "planar region") +
              ", edges " + rounded(r.shortest_edge) + " to " + rounded(r.longest_edge) + " m (bound " +
              rounded(r.max_element) + " m), smallest angle " + rounded(r.worst_angle_deg) + " degrees, median " +
              rounded(r.median_angle_deg));
}

}  // namespace clerestory
