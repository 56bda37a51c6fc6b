#include "solver/particles/photon_map.h"

#include <algorithm>

#include "solver/model/parallel.h"

namespace clerestory {
namespace {

struct Place {
  std::array<float, 3> at;
  std::uint32_t landing;
};

struct Range {
  std::size_t node, begin, end;
};

}  // namespace

PhotonMap::PhotonMap(std::span<const Landing> landings) {
  std::vector<Place> places(landings.size());
  for (std::uint32_t k = 0; k < places.size(); ++k) places[k] = {landings[k].position, k};
  std::size_t nodes = 0;
  for (std::size_t largest = places.size(), level = 1; largest >= kBucket; largest = largest - largest / 2, level *= 2)
    nodes += level;
  nodes_.resize(nodes);
  const auto halve = [&](const Range& r) {
    std::array<float, 3> low = places[r.begin].at, high = low;
    for (std::size_t k = r.begin + 1; k < r.end; ++k)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], places[k].at[axis]);
        high[axis] = std::max(high[axis], places[k].at[axis]);
      }
    std::uint32_t axis = 0;
    for (std::uint32_t other = 1; other < 3; ++other)
      if (high[other] - low[other] > high[axis] - low[axis]) axis = other;
    const std::size_t middle = r.begin + (r.end - r.begin) / 2;
    const auto from = places.begin();
    std::nth_element(from + static_cast<std::ptrdiff_t>(r.begin), from + static_cast<std::ptrdiff_t>(middle),
                     from + static_cast<std::ptrdiff_t>(r.end),
                     [axis](const Place& a, const Place& b) { return a.at[axis] < b.at[axis]; });
    nodes_[r.node] = {places[middle].at[axis], axis};
    return std::array{Range{2 * r.node + 1, r.begin, middle}, Range{2 * r.node + 2, middle, r.end}};
  };
  // Level by level while there are few, then each part on a thread of its own.
  constexpr std::size_t kParts = 32;
  std::vector<Range> parts{{0, 0, places.size()}};
  while (parts.size() < kParts && parts.front().end - parts.front().begin >= 2 * kBucket) {
    std::vector<Range> halves(2 * parts.size());
    parallel_for(parts.size(), 1, [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k) {
        const auto two = halve(parts[k]);
        halves[2 * k] = two[0], halves[2 * k + 1] = two[1];
      }
    });
    parts = std::move(halves);
  }
  position_.resize(places.size()), carried_.resize(places.size());
  parallel_for(parts.size(), 1, [&](std::size_t from, std::size_t to) {
    std::vector<Range> open;
    for (std::size_t k = from; k < to; ++k) {
      open.assign(1, parts[k]);
      while (!open.empty()) {
        const Range r = open.back();
        open.pop_back();
        if (r.end - r.begin < kBucket) {
          for (std::size_t i = r.begin; i < r.end; ++i) {
            const Landing& l = landings[places[i].landing];
            position_[i] = l.position, carried_[i] = {l.flux, l.patch, l.direction_and_way};
          }
          continue;
        }
        const auto two = halve(r);
        open.insert(open.end(), two.begin(), two.end());
      }
    }
  });
}

Spectrum irradiance(const PhotonMap& map, const SmoothSurface& surface, const Vec3& p, PatchId patch, std::size_t count,
                    double radius, PhotonsAround& room) {
  Spectrum E(0.0);
  photons_around(map, surface, p, patch, count, radius, room, [&](const Landing& photon, double weight) {
    const auto& [r, g, b] = photon.flux;
    E += Spectrum(double{r}, double{g}, double{b}) * weight;
  });
  return {std::max(0.0, E[0]), std::max(0.0, E[1]), std::max(0.0, E[2])};
}

}  // namespace clerestory
