#include "solver/hierarchy/caustic_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "solver/illumination/caustic_legs.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr int kMostHalvings = 16;  // of an element in one call: eight of its edges
constexpr double kSigmas = 3;

/// Luminous flux on the four parts of a triangle [W].
struct Parts {
  std::array<double, 4> flux{}, squares{};

  void add(const std::array<Vec3, 3>& corners, const Vec3& x, double f) {
    const Vec3 ab = corners[1] - corners[0], ac = corners[2] - corners[0], n = cross(ab, ac), d = x - corners[0];
    const double u = dot(n, cross(d, ac)) / dot(n, n), v = dot(n, cross(ab, d)) / dot(n, n);
    const std::size_t part = u > 0.5 ? 1 : v > 0.5 ? 2 : u + v < 0.5 ? 0 : 3;
    flux[part] += f, squares[part] += f * f;
  }
  double all() const { return flux[0] + flux[1] + flux[2] + flux[3]; }
  /// Between the two that differ most, less what may be chance.
  double difference() const {
    double most = 0;
    for (std::size_t s = 0; s < 4; ++s)
      for (std::size_t t = s + 1; t < 4; ++t)
        most = std::max(most, std::abs(flux[s] - flux[t]) - kSigmas * std::sqrt(squares[s] + squares[t]));
    return most;
  }
};

}  // namespace

std::size_t halve_at_caustics(ElementMesh& mesh, const Problem& before, std::span<const std::uint32_t> numbers,
                              const Field& E, const RefineOptions& options, const Monitor& monitor) {
  const std::span<const CausticLeg> legs = before.lights.caustics.legs;
  if (legs.empty()) return 0;
  std::vector<float> flux(legs.size());  // what glass leaves of it
  for (std::size_t k = 0; k < legs.size(); ++k)
    flux[k] = static_cast<float>(luminous_mean(landing_of(before, legs[k]).flux));
  std::vector<double> rest(E.size());  // light of an element that is no caustic
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = luminous_mean(E[i]);
  for (std::size_t k = 0; k < legs.size(); ++k)
    if (const PatchId p = patch_of(before.patches, legs[k]); p.valid())
      rest[p] -= double{flux[k]} / before.patches.area[p];
  std::size_t halved = 0;
  for (int pass = 0; pass < kMostHalvings && !monitor.should_stop(); ++pass) {
    const std::vector<std::uint32_t> leaves = mesh.leaves();
    const PatchSet patches = mesh.leaf_patches();
    std::vector<Parts> parts(leaves.size());
    for (std::size_t k = 0; k < legs.size(); ++k)
      if (const PatchId p = patch_of(patches, legs[k]); p.valid())
        parts[p].add(mesh.corner_positions(leaves[p]), legs[k].end(), double{flux[k]});
    std::vector<std::pair<double, std::uint32_t>> worst;
    for (std::size_t j = 0, i = 0; j < numbers.size(); ++j)
      for (const std::size_t end = i + mesh.leaves_under(numbers[j]); i < end; ++i) {
        const std::uint32_t e = leaves[i];
        if (mesh.longest_edge(e) < 2 * options.shortest_edge.of(mesh.patches(), PatchId{std::size_t{mesh[e].patch}}))
          continue;
        // Of four parts alike.
        const double all = parts[i].all() + std::max(0.0, rest[j]) * mesh[e].area;
        if (const double difference = parts[i].difference(); difference > options.tolerance * all / 4)
          worst.emplace_back(-difference, e);
      }
    // An element brings its neighbour with it, and a few more.
    const std::size_t room = (options.most_elements - std::min(options.most_elements, mesh.leaf_count())) / 4;
    std::ranges::sort(worst);
    worst.resize(std::min(worst.size(), room));
    if (worst.empty()) break;
    std::vector<std::uint32_t> marked;
    for (const auto& [difference, e] : worst) marked.push_back(e);
    halved += marked.size();
    mesh.split(marked);
  }
  return halved;
}

}  // namespace clerestory
