#pragma once
// Landings of particles, to be found by where they are: a balanced kd-tree.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/particles/landings.h"
#include "solver/particles/surface_kernels.h"

namespace clerestory {

/// A tree over landings that is halved at the median along its longest side down to buckets of 8 to 15. Nodes need no
/// pointers: those of a level lie side by side, and halves are as equal as can be, so ranges follow from the number.
/// 33 bytes a landing. Same for any thread count. Read-only, thread safe.
/// Source: Jensen, "Realistic image synthesis using photon mapping", 2001; Bentley, "Multidimensional binary search
/// trees used for associative searching", 1975.
class PhotonMap {
 public:
  struct Neighbour {
    float distance2;       ///< [m2]
    std::uint32_t photon;  ///< number in this map
  };

  PhotonMap() = default;
  /// Cost: O(n log n), on all threads. Up to 2^31 landings.
  explicit PhotonMap(std::span<const Landing> landings);

  std::size_t size() const { return position_.size(); }
  Landing operator[](std::size_t photon) const {
    const Carried& c = carried_[photon];
    return {position_[photon], c.flux, c.patch, c.direction_and_way};
  }

  /// Up to `count` landings that are nearest to p and nearer than `radius`, of those that `counts` likes; in no order.
  ///
  /// found    room for them that is used again; filled with the result.
  /// returns  radius squared that all lie within: of the farthest where there are `count`, else that given [m2].
  template <class Counts>
  double nearest(const Vec3& p, double radius, std::size_t count, std::vector<Neighbour>& found,
                 const Counts& counts) const;
  double nearest(const Vec3& p, double radius, std::size_t count, std::vector<Neighbour>& found) const {
    return nearest(p, radius, count, found, [](const Landing&) { return true; });
  }

 private:
  struct Node {
    float at;
    std::uint32_t axis;
  };
  static constexpr std::size_t kBucket = 16;  // smaller ones are not halved

  std::vector<Node> nodes_;  ///< node k has the halves 2 k + 1 and 2 k + 2
  // What a search looks at, and the rest: a query reads three times as many places as it finds.
  std::vector<std::array<float, 3>> position_;
  struct Carried {
    std::array<float, 3> flux;
    std::uint32_t patch, direction_and_way;
  };
  std::vector<Carried> carried_;
};

/// Room that look-ups use again.
struct PhotonsAround {
  std::vector<PhotonMap::Neighbour> found;
  std::vector<SurfaceKernel::Part> parts;
};
/// Calls take(landing, weight [1/m2]) for those on the smooth surface around p among the `count` landings that are
/// nearest within `radius` of point p of a patch and face as it does: by the kernel 1 - (r / R)^2 over that surface, R
/// the distance of the farthest, the sum of flux times weight is the irradiance there.
template <class Take>
void photons_around(const PhotonMap& map, const SmoothSurface& surface, const Vec3& p, PatchId patch, std::size_t count,
                    double radius, PhotonsAround& room, const Take& take) {
  const PatchSet& patches = surface.patches();
  const double within = map.nearest(p, radius, count, room.found, [&](const Landing& photon) {
    return dot(patches.normal[photon.patch], patches.normal[patch]) > SmoothSurface::kAlike;
  });
  if (room.found.empty()) return;
  const SurfaceKernel kernel =
      surface.kernel(p, {&patch.value, 1}, std::sqrt(within), KernelShape::epanechnikov, room.parts);
  for (const PhotonMap::Neighbour& at : room.found) {
    const Landing photon = map[at.photon];
    const auto part = std::ranges::find(room.parts, photon.patch, &SurfaceKernel::Part::patch);
    if (part != room.parts.end()) take(photon, kernel.weight(photon.position, double{part->height2}));
  }
}
/// That sum [W/m2].
Spectrum irradiance(const PhotonMap& map, const SmoothSurface& surface, const Vec3& p, PatchId patch, std::size_t count,
                    double radius, PhotonsAround& room);

template <class Counts>
double PhotonMap::nearest(const Vec3& p, double radius, std::size_t count, std::vector<Neighbour>& found,
                          const Counts& counts) const {
  found.clear();
  if (position_.empty() || count == 0) return radius * radius;
  const std::array<float, 3> at{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  auto within = static_cast<float>(std::min(radius * radius, 1e38));
  const auto farther = [](const Neighbour& a, const Neighbour& b) { return a.distance2 < b.distance2; };
  struct Part {
    std::size_t node, begin, end;
    float distance2;
  };
  std::array<Part, 64> stack;
  std::size_t depth = 0;
  stack[depth++] = {0, 0, position_.size(), 0};
  while (depth > 0) {
    auto [node, begin, end, distance2] = stack[--depth];
    if (distance2 >= within) continue;
    while (end - begin >= kBucket) {
      const std::size_t middle = begin + (end - begin) / 2;
      const float beyond = at[nodes_[node].axis] - nodes_[node].at, d2 = beyond * beyond;
      if (beyond < 0) {
        if (d2 < within) stack[depth++] = {2 * node + 2, middle, end, d2};
        node = 2 * node + 1, end = middle;
      } else {
        if (d2 < within) stack[depth++] = {2 * node + 1, begin, middle, d2};
        node = 2 * node + 2, begin = middle;
      }
    }
    for (std::size_t k = begin; k < end; ++k) {
      const auto& [x, y, z] = position_[k];
      const float dx = x - at[0], dy = y - at[1], dz = z - at[2];
      const float d2 = dx * dx + dy * dy + dz * dz;
      if (!(d2 < within) || !counts((*this)[k])) continue;
      const Neighbour neighbour{d2, static_cast<std::uint32_t>(k)};
      if (found.size() < count) {
        found.push_back(neighbour);
        if (found.size() < count) continue;
        std::make_heap(found.begin(), found.end(), farther);
      } else {
        // The farthest makes room: it is sifted down from the top.
        std::size_t hole = 0;
        for (std::size_t child = 1; child < count; child = 2 * hole + 1) {
          if (child + 1 < count && found[child].distance2 < found[child + 1].distance2) ++child;
          if (!(d2 < found[child].distance2)) break;
          found[hole] = found[child], hole = child;
        }
        found[hole] = neighbour;
      }
      within = found.front().distance2;
    }
  }
  return found.size() < count ? radius * radius : double{within};
}

}  // namespace clerestory
