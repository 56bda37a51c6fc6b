#include "solver/annual/sun_in_rooms.h"

#include <algorithm>
#include <array>
#include <limits>

#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/sampling/unit_square.h"
#include "solver/visibility/shadow_rays.h"

namespace clerestory {
namespace {

constexpr std::size_t kRays = 2;   ///< of an element and hour
constexpr double kMostFactor = 4;  ///< of what is known between nodes: beyond that they know nothing of this hour

/// A point of an element, and the flux that it stands for where a plane that faces the sun has 1.
struct Place {
  Vec3 at, normal;
  double flux;  ///< area times what is sent on from the room's side, luminous mean [m2]
  std::uint32_t room;
};

std::vector<Place> places_on(const PatchSet& elements, const RayScene& rays, const std::vector<bool>& sunlit,
                             std::uint64_t seed) {
  std::vector<Place> places;
  for (std::size_t i = 0; i < elements.patch_count(); ++i) {
    if (!sunlit[i]) continue;
    const auto add = [&](std::uint32_t room, double flux) {
      if (!(flux > 0) || (!elements.rooms.empty() && elements.rooms[room] == kOutdoors)) return;
      for (std::uint32_t k = 0; k < kRays; ++k) {
        const auto u = sobol4(k, stream_key(seed, kSunOnElements, i));
        const Vec3 p = point_on_triangle(elements.corner_positions(PatchId{i}), u[0], u[1]);
        places.push_back({rays.off_surface(p, elements.normal[i]), elements.normal[i], flux / kRays, room});
      }
    };
    add(elements.room_of(i), elements.area[i] * luminous_mean(elements.rho[i]));
    for (const auto& [behind, share] : elements.patches_behind(i))  // what a diffuser passes on leaves its other side
      add(elements.room_of(behind.value), elements.area[i] * share * luminous_mean(elements.tau[behind]));
  }
  return places;
}

/// What further reflections make of a watt that is sent on: m.
std::vector<double> echoes(const ReflectedDaylight& reflected, std::size_t rooms, std::size_t nodes) {
  std::vector<double> m(rooms, std::numeric_limits<double>::infinity());
  for (std::size_t r = 0; r < rooms; ++r)
    for (std::size_t k = 0; k < nodes; ++k)
      if (const std::size_t at = r * nodes + k; reflected.first_flux[at] > 0)
        m[r] = std::min(m[r], reflected.all_flux[at] / reflected.first_flux[at]);
  return m;
}

}  // namespace

std::vector<float> sun_in_rooms(const PatchSet& elements, const RayScene& rays, const ReflectedDaylight& reflected,
                                std::span<const SunOfHour> suns, std::span<const std::size_t> hour_of_sun,
                                std::span<const AmongNodes> of_hour, std::uint64_t seed) {
  const std::size_t rooms = elements.room_count(), nodes = reflected.sun_ways.size(), H = of_hour.size();
  const std::vector<Place> places = places_on(elements, rays, reflected.sunlit, seed);
  const std::vector<double> m = echoes(reflected, rooms, nodes);
  std::vector<float> factor(rooms * H, 1.0f);
  const double far = 4 * rays.diameter();
  parallel_for(suns.size(), 8, [&](std::size_t begin, std::size_t end) {
    std::vector<double> D(rooms);
    Vec3 to_sun;
    auto shadows = shadow_rays<const Place*>(rays, [&](const Place* place, const Spectrum& passes) {
      D[place->room] += place->flux * dot(place->normal, to_sun) * luminous_mean(passes);
    });
    for (std::size_t s = begin; s < end; ++s) {
      std::fill(D.begin(), D.end(), 0.0);
      to_sun = suns[s].direction;
      for (const Place& place : places)
        if (dot(place.normal, to_sun) > 0) shadows.send(place.at, place.at + to_sun * far, &place);
      shadows.trace();
      const AmongNodes& among = of_hour[hour_of_sun[s]];
      for (std::size_t r = 0; r < rooms; ++r) {
        double known = 0, all = 0;
        for (std::size_t k = 0; k < among.node.size(); ++k) {
          known += among.weight[k] * reflected.first_flux[r * nodes + among.node[k]];
          all += among.weight[k] * reflected.all_flux[r * nodes + among.node[k]];
        }
        const bool is_outdoors = !elements.rooms.empty() && elements.rooms[r] == kOutdoors;
        if (all > 0 && m[r] < std::numeric_limits<double>::infinity() && !is_outdoors)
          factor[r * H + hour_of_sun[s]] =
              static_cast<float>(std::clamp(1 + m[r] * (D[r] - known) / all, 0.0, kMostFactor));
      }
    }
  });
  return factor;
}

}  // namespace clerestory
