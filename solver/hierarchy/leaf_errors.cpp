#include "solver/hierarchy/leaf_errors.h"

#include <algorithm>
#include <cmath>

#include "solver/hierarchy/gradients.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

/// The darkest irradiance whose relative error counts, as share of the room's mean.
constexpr double kDark = 0.02;
/// Share of the difference between corners that may hide a shadow which lies between them.
constexpr double kSteep = 0.25;

double mean_of(const ElementMesh::Corners& point, const std::vector<double>& at) {
  return (at[point[0]] + at[point[1]] + at[point[2]]) / 3;
}

}  // namespace

std::vector<std::uint32_t> LeafErrors::changed_leaves() {
  const std::size_t before = points_.size(), now = mesh_.size();
  points_.resize(now);
  is_changed_.assign(E_.size(), false);
  for (std::uint32_t e = static_cast<std::uint32_t>(before); e < now; ++e) {
    if (!mesh_[e].is_leaf()) continue;
    points_[e] = mesh_.points_of(e);
    for (const std::uint32_t p : points_[e]) is_changed_[p] = true;
  }
  std::vector<std::uint32_t> leaves;
  for (std::uint32_t e = 0; e < now; ++e) {
    if (!mesh_[e].is_leaf()) continue;
    const auto any = [&](const std::vector<bool>& is) {
      return is[points_[e][0]] || is[points_[e][1]] || is[points_[e][2]];
    };
    const auto all = [&](const std::vector<bool>& is) {
      return is[points_[e][0]] && is[points_[e][1]] && is[points_[e][2]];
    };
    if (any(is_changed_) && all(field_.known)) leaves.push_back(e);
  }
  return leaves;
}

void LeafErrors::find_rooms(const std::vector<std::uint32_t>& leaves) {
  const PatchSet& patches = mesh_.patches();
  mean_.resize(patches.room_count()), area_.resize(mean_.size());
  for (const std::uint32_t leaf : leaves) {
    const std::size_t room = patches.room_of(mesh_[leaf].patch);
    mean_[room] += mesh_[leaf].area * mean_of(points_[leaf], E_);
    area_[room] += mesh_[leaf].area;
  }
  for (std::size_t room = 0; room < area_.size(); ++room)
    if (area_[room] > 0) mean_[room] /= area_[room];
}

std::vector<LeafError> LeafErrors::of_changed() {
  for (std::size_t p = E_.size(); p < field_.known.size(); ++p) {
    E_.push_back(luminous_mean(field_.E[p]));
    soft_E_.push_back(E_.back() - luminous_mean(field_.delta_light[p]));
  }
  const std::vector<std::uint32_t> leaves = changed_leaves();
  if (mean_.empty()) find_rooms(leaves);
  find_gradients(mesh_, leaves, E_, is_changed_, gradient_);
  find_gradients(mesh_, leaves, soft_E_, is_changed_, soft_gradient_);
  std::vector<LeafError> errors;
  errors.reserve(leaves.size());
  for (const std::uint32_t leaf : leaves) {
    const ElementMesh::Corners& point = points_[leaf];
    const auto x = mesh_.corner_positions(leaf);
    const auto off_in = [&](const std::vector<double>& of, const std::vector<Vec3>& gradient) {
      double off = 0;
      for (std::size_t k = 0; k < 3; ++k) off = std::max(off, std::abs(bulge(x, point, gradient, k)));
      const auto [low, high] = std::minmax({of[point[0]], of[point[1]], of[point[2]]});
      return mesh_[leaf].penumbra ? off : std::max(off, kSteep * (high - low));
    };
    const std::size_t room = mesh_.patches().room_of(mesh_[leaf].patch);
    const double off = off_in(E_, gradient_), soft = off_in(soft_E_, soft_gradient_),
                 E = std::max(mean_of(point, E_), kDark * mean_[room]),
                 share = area_[room] > 0 ? std::sqrt(mesh_[leaf].area / area_[room]) : 0;
    errors.push_back({leaf, off, soft, E, mean_of(point, field_.std_error), E > 0 ? off / E * share : 0,
                      mean_[room] > 0 ? soft / mean_[room] * share : 0});
  }
  return errors;
}

}  // namespace clerestory
