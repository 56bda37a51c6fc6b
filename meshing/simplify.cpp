#include "meshing/simplify.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModHausdorffT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalDeviationT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <OpenMesh/Tools/Decimater/Observer.hh>

#include "meshing/fine_parts.h"
#include "meshing/surface_distance.h"
#include "solver/model/parallel.h"

namespace clerestory {
namespace {

constexpr double kLargestTurn = 15;  ///< of a facet [degrees]
constexpr double kLeastGain = 0.1;   ///< share of a part's faces that must go
constexpr double kWideFacet = 2;     ///< facets are wide that are higher than so many times the detail

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
  VertexAttributes(OpenMesh::Attributes::Status);
  EdgeAttributes(OpenMesh::Attributes::Status);
  HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge | OpenMesh::Attributes::Status);
  FaceAttributes(OpenMesh::Attributes::Normal | OpenMesh::Attributes::Status);
};
using PartMesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

/// Of the two vertices of a collapse: its cost goes with their square.
constexpr unsigned kMostFacesAround = 64;
/// No facet loses more of its height in a collapse.
constexpr double kLeastHeight = 0.25;

/// Collapses that bend a wide facet, leave one without height or crowd a vertex are not allowed.
template <class MeshT>
class ModKeepWideT : public OpenMesh::Decimater::ModBaseT<MeshT> {
 public:
  DECIMATING_MODULE(ModKeepWideT, MeshT, KeepWide);
  explicit ModKeepWideT(Mesh& mesh) : Base(mesh, true) {}

  void set(double wide, double flat) {
    wide_ = wide;
    flat_ = flat;
  }
  float collapse_priority(const CollapseInfo& collapse) override {
    Mesh& mesh = Base::mesh();
    if (mesh.valence(collapse.v0) + mesh.valence(collapse.v1) > kMostFacesAround) return Base::ILLEGAL_COLLAPSE;
    for (const auto f : mesh.vf_range(collapse.v0)) {
      auto v = mesh.cfv_iter(f);
      std::array<typename MeshT::Point, 3> p, moved;
      for (std::size_t k = 0; k < 3; ++k, ++v) {
        p[k] = mesh.point(*v);
        moved[k] = *v == collapse.v0 ? collapse.p1 : p[k];
      }
      const auto n = (p[1] - p[0]) % (p[2] - p[0]);
      const bool is_wide = n.norm() > wide_ * longest(p);
      if (is_wide && std::abs((collapse.p1 - p[0]) | n) > flat_ * n.norm()) return Base::ILLEGAL_COLLAPSE;
      if (f == collapse.fl || f == collapse.fr) continue;
      const double height = ((moved[1] - moved[0]) % (moved[2] - moved[0])).norm() / longest(moved);
      if (height <= std::max(flat_, kLeastHeight * n.norm() / longest(p))) return Base::ILLEGAL_COLLAPSE;
    }
    return Base::LEGAL_COLLAPSE;
  }

 private:
  static double longest(const std::array<typename MeshT::Point, 3>& p) {
    return std::max({(p[1] - p[0]).norm(), (p[2] - p[1]).norm(), (p[0] - p[2]).norm()});
  }
  double wide_ = 0, flat_ = 0;
};

class StopWhenInterrupted : public OpenMesh::Decimater::Observer {
 public:
  explicit StopWhenInterrupted(const Monitor& monitor) : Observer(1000), monitor_(monitor) {}
  void notify(std::size_t) override {}
  bool abort() const override { return monitor_.is_interrupted(); }

 private:
  const Monitor& monitor_;
};

struct SimplerPart {
  std::vector<Face> faces;
  double moved = 0;
};

std::vector<TriangleCorners> places(const FaceComplex& complex, std::span<const Face> faces) {
  std::vector<TriangleCorners> result;
  for (const Face& f : faces)
    result.push_back({complex.vertices[f.corner[0]], complex.vertices[f.corner[1]], complex.vertices[f.corner[2]]});
  return result;
}

std::optional<SimplerPart> simpler(const FaceComplex& complex, const FinePart& part, double detail,
                                   const Monitor& monitor) {
  std::vector<Face> original;
  std::vector<std::uint32_t> vertices;  // of the complex, by vertex of the mesh
  for (const std::uint32_t f : part.faces) {
    original.push_back(complex.faces[f]);
    for (const std::uint32_t v : complex.faces[f].corner) vertices.push_back(v);
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());

  PartMesh mesh;
  for (const std::uint32_t v : vertices) {
    const Vec3& p = complex.vertices[v];
    const auto h = mesh.add_vertex({p.x, p.y, p.z});
    if (std::ranges::binary_search(part.held_vertices, v)) mesh.status(h).set_locked(true);
  }
  const auto in_mesh = [&](std::uint32_t v) {
    return mesh.vertex_handle(static_cast<unsigned>(std::ranges::lower_bound(vertices, v) - vertices.begin()));
  };
  for (const Face& f : original)
    if (!mesh.add_face(in_mesh(f.corner[0]), in_mesh(f.corner[1]), in_mesh(f.corner[2])).is_valid()) return {};
  mesh.update_face_normals();

  OpenMesh::Decimater::DecimaterT<PartMesh> decimater(mesh);
  OpenMesh::Decimater::ModQuadricT<PartMesh>::Handle quadric;
  OpenMesh::Decimater::ModHausdorffT<PartMesh>::Handle hausdorff;
  OpenMesh::Decimater::ModNormalDeviationT<PartMesh>::Handle normals;
  ModKeepWideT<PartMesh>::Handle wide;
  decimater.add(quadric);
  decimater.add(wide);
  decimater.add(normals);
  decimater.add(hausdorff);
  decimater.module(quadric).unset_max_err();
  decimater.module(hausdorff).set_tolerance(detail);
  decimater.module(normals).set_normal_deviation(2 * kLargestTurn);
  decimater.module(wide).set(kWideFacet * detail, complex.allowed.contact);
  if (!decimater.initialize()) return {};
  StopWhenInterrupted stop(monitor);
  decimater.set_observer(&stop);
  decimater.decimate();
  if (monitor.is_interrupted()) return {};

  SimplerPart result;
  for (const auto f : mesh.faces()) {  // those that are left
    const Face& was = original[static_cast<std::size_t>(f.idx())];
    Face now = was;
    std::size_t k = 0;
    for (const auto v : mesh.fv_range(f)) {
      now.corner[k] = vertices[static_cast<std::size_t>(v.idx())];
      const auto at = static_cast<std::size_t>(std::ranges::find(was.corner, now.corner[k]) - was.corner.begin());
      now.read_at[k++] = at < was.corner.size() ? was.read_at[at] : Face::kNone;
    }
    result.faces.push_back(now);
  }
  if (static_cast<double>(result.faces.size()) > (1 - kLeastGain) * static_cast<double>(original.size())) return {};
  const auto before = places(complex, original), after = places(complex, result.faces);
  const auto out = farthest_distance(after, before, detail), in = farthest_distance(before, after, detail);
  if (!out || !in) return {};
  result.moved = std::max(*out, *in);
  return result;
}

}  // namespace

void simplify(FaceComplex& complex, std::span<const Material> materials, double detail, MeshReport& report,
              const Monitor& monitor) {
  const std::vector<Face> flat = std::exchange(complex.flat, {});
  if (!(detail > 0)) return;
  complex.faces.insert(complex.faces.end(), flat.begin(), flat.end());
  const std::vector<FinePart> parts = fine_parts(complex, materials, kWideFacet * detail);

  omerr().disable();  // parts that are not manifold are told by what add_face returns
  std::vector<std::optional<SimplerPart>> simplified(parts.size());
  parallel_for(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) simplified[k] = simpler(complex, parts[k], detail, monitor);
  });
  omerr().enable();

  std::vector<bool> gone(complex.faces.size());
  double moved = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (!simplified[k]) continue;
    ++report.simplified_parts;
    report.simplified_faces += parts[k].faces.size() - simplified[k]->faces.size();
    moved = std::max(moved, simplified[k]->moved);
    // The part's first faces make room for what is left of it.
    for (const std::uint32_t f : parts[k].faces) gone[f] = true;
    for (std::size_t i = 0; i < simplified[k]->faces.size(); ++i) {
      complex.faces[parts[k].faces[i]] = simplified[k]->faces[i];
      gone[parts[k].faces[i]] = false;
    }
  }
  report.simplified_by = moved * complex.size;
  std::size_t kept = 0;
  for (std::size_t f = 0; f < complex.faces.size(); ++f)
    if (!gone[f] && complex.has_area(complex.faces[f].corner)) complex.faces[kept++] = complex.faces[f];
  complex.faces.resize(kept);
}

}  // namespace clerestory
