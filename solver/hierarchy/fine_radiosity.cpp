#include "solver/hierarchy/fine_radiosity.h"

#include <algorithm>
#include <span>
#include <utility>

#include "solver/hierarchy/vertex_field.h"
#include "solver/model/assert.h"

namespace clerestory {
namespace {

/// Of the mean of an element that its darkest corner has at least as long as means of others tell: they are drawn on
/// into corners, as if light were linear there.
constexpr double kLeast = 0.1;
/// Where vertices and the transport differ by more than that factor, neither tells how light goes across an element.
constexpr double kAgree = 2;

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
  place_.reserve(leaves.size());
  for (std::size_t j = 0; j < leaves.size(); ++j) {
    const auto x = mesh.corner_positions(leaves[j]);
    const Vec3 a = x[1] - x[0], b = x[2] - x[0], n = cross(a, b);
    const double squared = std::max(clerestory::dot(n, n), 1e-300);
    place_.push_back({x[0], in_float(cross(b, n) / squared), in_float(cross(n, a) / squared), leaves[j]});
    soft_.set(j, at_least(E[j] - delta_light[j], Spectrum(0.0)));
  }
  E_ = values_at_points(mesh, leaves, soft_);
  reset();
  for (std::size_t j = 0; j < leaves.size(); ++j) {
    // As linear as the darkest corner allows.
    const auto corner = mesh.points_of(leaves[j]);
    const Spectrum mean = mean_of(E_, corner);
    Spectrum share(1.0);
    for (int c = 0; c < E_.channels; ++c)
      for (const std::uint32_t p : corner) {
        const double below = mean[c] - E_.at(p, c), most = (1 - kLeast) * soft_.at(j, c);
        if (below > most) share[c] = std::min(share[c], most / below);
      }
    add_leaf(j, leaves[j], [&](std::uint32_t p) { return (E_[p] - mean) * share; });
  }
}

void FineRadiosity::take(const VertexField& field) {
  E_.value.resize(field.E.value.size());
  for (std::size_t p = 0; p < E_.size(); ++p) {
    CLERESTORY_ASSERT(field.known[p], ==, true);
    E_.set(p, at_least(field.E[p] - field.delta_light[p], Spectrum(0.0)));
  }
  reset();
  const std::vector<std::uint32_t> leaves = mesh_.leaves();
  std::size_t begin = 0;
  for (std::size_t j = 0; j < place_.size(); ++j) {
    const auto own = std::span(leaves).subspan(begin, mesh_.leaves_under(place_[j].root));
    Spectrum flux(0.0), scale(0.0), mean(0.0);
    for (const std::uint32_t leaf : own) flux += mesh_[leaf].area * mean_of(E_, mesh_.points_of(leaf));
    for (int c = 0; c < E_.channels; ++c) {
      const double known = soft_.at(j, c) * mesh_[place_[j].root].area;
      if (!(known < kAgree * flux[c] && flux[c] < kAgree * known)) continue;
      scale[c] = known / flux[c], mean[c] = soft_.at(j, c);
    }
    for (const std::uint32_t leaf : own) add_leaf(j, leaf, [&](std::uint32_t p) { return E_[p] * scale - mean; });
    begin += own.size();
  }
}

void FineRadiosity::reset() {
  nodes_.resize(mesh_.size());
  for (std::size_t e = 0; e < nodes_.size(); ++e)
    if (mesh_[e].parted) nodes_[e] = {mesh_[e].first, mesh_[e].at, mesh_[e].edge};
  above_.clear();
  above_.reserve(3 * static_cast<std::size_t>(E_.channels) * mesh_.leaf_count());
}

/// above_at(p): irradiance at point p above the mean of the element.
template <class AboveAt>
void FineRadiosity::add_leaf(std::size_t element, std::uint32_t leaf, const AboveAt& above_at) {
  const auto of_leaf = 3 * static_cast<std::size_t>(E_.channels);
  nodes_[leaf] = {static_cast<std::uint32_t>(above_.size() / of_leaf), 0, 0};
  const Spectrum rho = elements_.rho[element];
  for (const std::uint32_t p : mesh_.points_of(leaf)) {
    const Spectrum above = rho * above_at(p);
    for (int c = 0; c < E_.channels; ++c) above_.push_back(static_cast<float>(above[c]));
  }
}

Spectrum FineRadiosity::above_mean(PatchId element, const Vec3& x) const {
  const Place& place = place_[element.value];
  const Vec3 d = x - place.corner;
  std::array<double, 3> share{0, std::max(0.0, dot(place.to_1, d)), std::max(0.0, dot(place.to_2, d))};
  if (const double sum = share[1] + share[2]; sum > 1)
    share[1] /= sum, share[2] /= sum;
  else
    share[0] = 1 - sum;
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
