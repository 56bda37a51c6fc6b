#include "solver/hierarchy/fine_radiosity.h"

#include <algorithm>
#include <utility>

#include "solver/hierarchy/vertex_field.h"

namespace clerestory {
namespace {

/// Of the mean of an element that its darkest corner has at least: what is linear is drawn on into corners.
constexpr double kLeast = 0.1;

Spectrum mean_of(const Field& at, const ElementMesh::Corners& corner) {
  return (at[corner[0]] + at[corner[1]] + at[corner[2]]) / 3;
}

Spectrum at_least(const Spectrum& value, const Spectrum& least) {
  return {std::max(value[0], least[0]), std::max(value[1], least[1]), std::max(value[2], least[2])};
}

std::array<float, 3> in_float(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

double dot(const std::array<float, 3>& a, const Vec3& b) {
  return double{a[0]} * b.x + double{a[1]} * b.y + double{a[2]} * b.z;
}

/// What stands at the points of a mesh by means E of its leaves. At the end of a surface all leaves around a point lie
/// to one side of it: what they have there is told by how light changes across them, for which the means of those
/// around are a start.
Field values_at_points(const ElementMesh& mesh, const std::vector<std::uint32_t>& leaves, const Field& E) {
  constexpr int kTimes = 2;
  const std::size_t points = mesh.points().position.size();
  Field value;
  for (int time = 0; time < kTimes; ++time) {
    Field sum(points, E.channels);
    std::vector<double> weight(points);
    for (std::size_t j = 0; j < leaves.size(); ++j) {
      const auto corner = mesh.points_of(leaves[j]);
      const double area = mesh[leaves[j]].area;
      for (const std::uint32_t p : corner) {
        sum.add(p, (time == 0 ? E[j] : E[j] + value[p] - mean_of(value, corner)) * area);
        weight[p] += area;
      }
    }
    for (std::size_t p = 0; p < points; ++p)
      if (weight[p] > 0) sum.set(p, sum[p] / weight[p]);
    value = std::move(sum);
  }
  return value;
}

}  // namespace

FineRadiosity::FineRadiosity(const ElementMesh& mesh, const PatchSet& elements, const Field& E,
                             const Field& delta_light)
    : mesh_(mesh), elements_(elements), soft_(E.size(), E.channels) {
  const std::vector<std::uint32_t> leaves = mesh.leaves();
  for (std::size_t j = 0; j < leaves.size(); ++j) {
    const auto x = mesh.corner_positions(leaves[j]);
    const Vec3 a = x[1] - x[0], b = x[2] - x[0], n = cross(a, b);
    const double squared = std::max(clerestory::dot(n, n), 1e-300);
    place_.push_back({x[0], in_float(cross(b, n) / squared), in_float(cross(n, a) / squared), leaves[j]});
    soft_.set(j, at_least(E[j] - delta_light[j], Spectrum(0.0)));
  }
  E_ = values_at_points(mesh, leaves, soft_);
  set_corners();
}

void FineRadiosity::take(const VertexField& field) {
  E_.value.resize(field.E.value.size());
  for (std::size_t p = 0; p < E_.size(); ++p)
    if (field.known[p]) E_.set(p, at_least(field.E[p] - field.delta_light[p], Spectrum(0.0)));
  set_corners();
}

void FineRadiosity::set_corners() {
  nodes_.resize(mesh_.size());
  for (std::size_t e = 0; e < nodes_.size(); ++e)
    if (mesh_[e].parted) nodes_[e] = {mesh_[e].first, mesh_[e].at, mesh_[e].edge};
  const std::vector<std::uint32_t> leaves = mesh_.leaves();
  const auto channels = static_cast<std::size_t>(E_.channels);
  above_.clear();
  std::size_t begin = 0;
  for (std::size_t j = 0; j < place_.size(); ++j) {
    const auto own = std::span(leaves).subspan(begin, mesh_.leaves_under(place_[j].root));
    Spectrum flux(0.0);
    for (const std::uint32_t leaf : own) flux += mesh_[leaf].area * mean_of(E_, mesh_.points_of(leaf));
    const Spectrum missing = soft_[j] - flux / mesh_[place_[j].root].area, rho = elements_.rho[j];
    for (std::size_t k = 0; k < own.size(); ++k) {
      nodes_[own[k]] = {static_cast<std::uint32_t>(begin + k), 0, 0};
      for (const std::uint32_t p : mesh_.points_of(own[k])) {
        const Spectrum above = rho * (at_least(E_[p] + missing, kLeast * soft_[j]) - soft_[j]);
        for (std::size_t c = 0; c < channels; ++c) above_.push_back(static_cast<float>(above.c[c]));
      }
    }
    begin += own.size();
  }
}

Spectrum FineRadiosity::above_mean(PatchId element, const Vec3& x) const {
  const Place& place = place_[element.value];
  const Vec3 d = x - place.corner;
  std::array<double, 3> share{0, std::max(0.0, dot(place.to_1, d)), std::max(0.0, dot(place.to_2, d))};
  share[0] = std::max(0.0, 1 - share[1] - share[2]);
  Node node = nodes_[place.root];
  while (node.at > 0) {
    const bool second = go_to_part(node.at, node.edge, share);
    node = nodes_[node.first + second];
  }
  const auto channels = static_cast<std::size_t>(E_.channels);
  const float* corner = &above_[3 * channels * node.first];
  const auto of = [&](std::size_t c) {
    return share[0] * double{corner[c]} + share[1] * double{corner[channels + c]} +
           share[2] * double{corner[2 * channels + c]};
  };
  return channels == 1 ? Spectrum(of(0)) : Spectrum(of(0), of(1), of(2));
}

}  // namespace clerestory
