#include "solver/spaces/rooms.h"

#include <algorithm>
#include <bit>
#include <map>
#include <numeric>

#include "solver/model/box.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/openings/openings.h"
#include "solver/sampling/unit_square.h"

namespace clerestory {
namespace {

constexpr std::size_t kRays = 1 << 17;  ///< in all, about
constexpr std::size_t kFewestRays = 8, kMostRays = 32;
constexpr int kSweeps = 24;
/// So long those that have a name, and the open air, have no vote: all of one label at once, they would run through a
/// door while those behind it still have a label each.
constexpr int kSweepsAlone = 6;
constexpr double kLeastRoom = 1e-3;  ///< of all area: what is smaller and has no name is no room of its own
/// Two groups are one room when the smaller one sends more of its light to the other, or less to itself.
constexpr double kMostBetween = 0.1, kLeastWithin = 0.5;

/// Who sees whom: symmetric, by patch; the number after the last patch stands for the open air.
struct Sight {
  struct Edge {
    std::uint32_t other;
    float weight;  ///< area over rays [m2]
    bool parted;   ///< by glass, a mirror or an opening
  };
  std::vector<std::size_t> begin;
  std::vector<Edge> edges;

  std::span<const Edge> of(std::size_t i) const { return std::span(edges).subspan(begin[i], begin[i + 1] - begin[i]); }
  std::size_t size() const { return begin.size() - 1; }
};

bool passes_an_opening(const Problem& problem, std::span<const OpeningSphere> spheres, const Ray& ray,
                       double distance) {
  const auto openings = problem.lights.sky_openings();
  for (std::size_t o = 0; o < openings.size(); ++o) {
    const bool near = spheres[o].is_passed(ray.origin, ray.direction) ||
                      spheres[o].is_passed(ray.origin + ray.direction * distance, -ray.direction);
    if (near && is_passed(openings[o], ray.origin, ray.direction, distance)) return true;
  }
  return false;
}

Sight look_around(const Problem& problem, std::uint64_t seed, const Monitor& monitor) {
  const PatchSet& patches = problem.patches;
  const std::size_t n = patches.patch_count();
  const auto air = static_cast<std::uint32_t>(n);
  const std::size_t rays = std::bit_floor(std::clamp(kRays / std::max<std::size_t>(n, 1), kFewestRays, kMostRays));
  const bool has_open_air = problem.lights.sky || !problem.lights.suns.empty();
  std::vector<OpeningSphere> spheres;
  for (const LightArea& opening : problem.lights.sky_openings()) spheres.emplace_back(opening);
  constexpr std::uint32_t kNothing = 0xffffffff;
  std::vector<std::uint32_t> seen(n * rays, kNothing);
  std::vector<char> parted(n * rays);
  parallel_for(n, 32, [&](std::size_t from, std::size_t to) {
    std::vector<Ray> around(rays);
    std::vector<Hit> hits(rays);
    for (std::size_t i = from; i < to && !monitor.is_interrupted(); ++i) {
      const Frame frame(patches.normal[i]);
      const auto corners = patches.corner_positions(PatchId{i});
      const std::uint64_t key = stream_key(seed, kRoomRays, i);
      for (std::size_t k = 0; k < rays; ++k) {
        const auto u = sobol4(static_cast<std::uint32_t>(k), key);
        const Vec3 p = problem.rays.off_surface(point_on_triangle(corners, u[2], u[3]), frame.n);
        around[k] = {p, cosine_direction(frame, u[0], u[1])};
      }
      problem.rays.first_hits(patches, around, hits);
      for (std::size_t k = 0; k < rays; ++k) {
        const Hit& hit = hits[k];
        if (hit.escaped() ? !has_open_air : !hit.patch.valid()) continue;
        seen[i * rays + k] = hit.escaped() ? air : hit.patch.value;
        parted[i * rays + k] =
            hit.reflected || hit.transmittance != Spectrum(1.0) ||
            passes_an_opening(problem, spheres, around[k], hit.escaped() ? problem.rays.diameter() : hit.distance);
      }
    }
  });

  Sight sight;
  sight.begin.assign(n + 2, 0);
  for (std::size_t r = 0; r < seen.size(); ++r)
    if (seen[r] != kNothing) ++sight.begin[r / rays], ++sight.begin[seen[r]];
  std::exclusive_scan(sight.begin.begin(), sight.begin.end(), sight.begin.begin(), std::size_t{0});
  sight.edges.resize(sight.begin.back());
  std::vector<std::size_t> next(sight.begin.begin(), sight.begin.end() - 1);
  for (std::size_t r = 0; r < seen.size(); ++r) {
    if (seen[r] == kNothing) continue;
    const auto i = static_cast<std::uint32_t>(r / rays);
    const auto weight = static_cast<float>(patches.area[i] / static_cast<double>(rays));
    sight.edges[next[i]++] = {seen[r], weight, parted[r] != 0};
    sight.edges[next[seen[r]]++] = {i, weight, parted[r] != 0};
  }
  return sight;
}

/// Each takes the label that most of what it sees has.
std::vector<std::uint32_t> hand_labels_on(const Sight& sight, std::vector<std::uint32_t> label,
                                          const std::vector<bool>& is_fixed, std::uint64_t seed) {
  std::vector<std::uint32_t> order(sight.size());
  std::iota(order.begin(), order.end(), 0u);
  std::vector<double> votes(label.empty() ? 0 : *std::ranges::max_element(label) + 1, 0);
  std::vector<std::uint32_t> voted;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    // Another order each time: with one order, a label could run through all that follow each other.
    RandomStream random(seed, stream_key(kRoomRays, static_cast<std::uint64_t>(sweep)));
    for (std::size_t k = order.size(); k > 1; --k)
      std::swap(order[k - 1], order[static_cast<std::size_t>(random.uniform() * static_cast<double>(k))]);
    std::size_t changed = 0;
    for (const std::uint32_t i : order) {
      if (is_fixed[i] || sight.of(i).empty()) continue;
      voted.clear();
      for (const Sight::Edge& e : sight.of(i)) {
        if (e.parted || (sweep < kSweepsAlone && is_fixed[e.other])) continue;
        if (votes[label[e.other]] == 0) voted.push_back(label[e.other]);
        votes[label[e.other]] += e.weight;
      }
      std::uint32_t best = label[i];
      double most = votes[best];
      for (const std::uint32_t l : voted)
        if (votes[l] > most * (1 + 1e-9)) best = l, most = votes[l];
      for (const std::uint32_t l : voted) votes[l] = 0;
      changed += best != label[i];
      label[i] = best;
    }
    if (sweep >= kSweepsAlone && changed * 1000 < order.size()) break;
  }
  return label;
}

/// Joins labels that see too much of another, or too little of themselves, to the one that they see most of.
void join_labels(const Sight& sight, std::vector<std::uint32_t>& label, const std::vector<bool>& is_named,
                 std::uint32_t air) {
  for (int round = 0; round < kSweeps; ++round) {
    struct Flow {
      double free = 0, parted = 0;
    };
    std::map<std::array<std::uint32_t, 2>, Flow> between;
    std::map<std::uint32_t, double> all, within;
    for (std::size_t i = 0; i < sight.size(); ++i)
      for (const Sight::Edge& e : sight.of(i)) {
        all[label[i]] += e.weight;
        if (label[i] == label[e.other]) {
          within[label[i]] += e.weight;
          continue;
        }
        Flow& flow = between[{label[i], label[e.other]}];
        (e.parted ? flow.parted : flow.free) += e.weight;
      }
    // What is hardly a room by itself goes with what it sees most of; through glass only where it sees nothing else,
    // as a window's reveal before its pane, and then rather with the open air.
    struct Best {
      std::uint32_t other = 0;
      double weight = 0;
    };
    std::map<std::uint32_t, Best> best;
    for (const auto& [pair, flow] : between) {
      const bool is_room = within[pair[0]] >= kLeastWithin * all[pair[0]];
      if (is_room && flow.free < kMostBetween * all[pair[0]]) continue;
      constexpr double kByGlass = 0.01, kToAir = 4;
      const double weight = is_room ? flow.free : flow.free + kByGlass * (pair[1] == air ? kToAir : 1) * flow.parted;
      if (weight > best[pair[0]].weight) best[pair[0]] = {pair[1], weight};
    }
    // The smaller one joins, and none that others have joined in this round.
    std::map<std::uint32_t, std::uint32_t> joins;
    std::vector<std::pair<double, std::uint32_t>> by_size;
    for (const auto& [l, sum] : all) by_size.push_back({sum, l});
    std::sort(by_size.begin(), by_size.end());
    std::map<std::uint32_t, bool> was_joined;
    for (const auto& [sum, l] : by_size) {
      const auto found = best.find(l);
      if (found == best.end() || found->second.weight <= 0 || was_joined[l]) continue;
      if (is_named[l]) {  // what a name was given to but a part of takes the name
        const std::uint32_t whole = found->second.other;
        if (l == air || is_named[whole] || joins.contains(whole) || was_joined[whole]) continue;
        joins[whole] = l;
        was_joined[l] = true;
        continue;
      }
      if (joins.contains(found->second.other)) continue;
      joins[l] = found->second.other;
      was_joined[found->second.other] = true;
    }
    if (joins.empty()) return;
    for (std::uint32_t& l : label)
      if (const auto to = joins.find(l); to != joins.end()) l = to->second;
  }
}

/// Whether a point is inside of a volume.
bool contains(const NamedSpace& space, const Vec3& p) {
  return std::ranges::any_of(spans_at(space, p.x, p.y),
                             [&](const SpaceSpan& s) { return s.floor < p.z && p.z < s.ceiling; });
}

/// The named room of each patch, or kNone.
constexpr std::uint32_t kNone = 0xffffffff;
std::vector<std::uint32_t> named_room_of(const PatchSet& patches, const NamedRooms& named) {
  std::vector<std::uint32_t> room(patches.patch_count(), kNone);
  std::vector<Box> boxes;
  for (const NamedSpace& space : named.spaces) boxes.push_back(Box::around(space.vertices));
  // Volumes end at the walls' faces, or somewhat before or behind.
  constexpr double kOffWall = 0.05;
  parallel_for(room.size(), 256, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      for (std::size_t r = 0; r < named.by_surface.size() && room[i] == kNone; ++r)
        if (named.by_surface[r].has_surface[patches.surface(PatchId{i}).value])
          room[i] = static_cast<std::uint32_t>(named.spaces.size() + r);
      const auto c = patches.corner_positions(PatchId{i});
      const Vec3 p = (c[0] + c[1] + c[2]) / 3 + patches.normal[i] * kOffWall + patches.origin;
      for (std::size_t s = 0; s < boxes.size() && room[i] == kNone; ++s)
        if (named.spaces[s].has_volume() && boxes[s].touches(Box::around(std::span(&p, 1))) &&
            contains(named.spaces[s], p))
          room[i] = static_cast<std::uint32_t>(s);
    }
  });
  return room;
}

}  // namespace

Rooms find_rooms(const Problem& problem, const NamedRooms& named, std::uint64_t seed, const Monitor& monitor) {
  const PatchSet& patches = problem.patches;
  const std::size_t n = patches.patch_count(), named_count = named.spaces.size() + named.by_surface.size();
  // Labels: those with names, then the open air, then one for each patch.
  const auto air = static_cast<std::uint32_t>(named_count);
  std::vector<std::uint32_t> label = named_room_of(patches, named);
  std::vector<bool> is_fixed(n + 1), is_named(n + named_count + 1);
  for (std::size_t i = 0; i < n; ++i) {
    is_fixed[i] = label[i] != kNone;
    if (!is_fixed[i]) label[i] = static_cast<std::uint32_t>(named_count + 1 + i);
  }
  label.push_back(air);
  is_fixed[n] = true;
  for (std::size_t l = 0; l <= named_count; ++l) is_named[l] = true;
  const Sight sight = look_around(problem, seed, monitor);
  label = hand_labels_on(sight, std::move(label), is_fixed, seed);
  join_labels(sight, label, is_named, air);

  // The insides of frames and the gaps behind them are told together.
  const auto small = static_cast<std::uint32_t>(is_named.size());
  std::vector<double> area(is_named.size() + 1, 0);
  for (std::size_t i = 0; i < n; ++i) area[label[i]] += patches.area[i];
  const double least = kLeastRoom * patches.total_area();
  for (std::size_t i = 0; i < n; ++i)
    if (!is_named[label[i]] && area[label[i]] < least) area[small] += patches.area[i], label[i] = small;
  std::vector<std::uint32_t> order;
  std::vector<bool> is_there(area.size());
  for (std::size_t i = 0; i < n; ++i) is_there[label[i]] = true;
  for (std::uint32_t l = 0; l < area.size(); ++l)
    if (is_there[l]) order.push_back(l);
  const auto rank = [&](std::uint32_t l) { return std::pair(l == air ? 0 : l == small ? 2 : 1, -area[l]); };
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return rank(a) < rank(b); });
  Rooms rooms;
  std::vector<std::uint32_t> number(area.size(), 0);
  std::size_t nameless = 0;
  for (const std::uint32_t l : order) {
    number[l] = static_cast<std::uint32_t>(rooms.names.size());
    rooms.names.push_back(l == air                  ? "outdoors"
                          : l == small              ? "smaller spaces"
                          : l < named.spaces.size() ? named.spaces[l].name
                          : l < named_count         ? named.by_surface[l - named.spaces.size()].name
                                                    : "room " + std::to_string(++nameless));
  }
  rooms.of_patch.resize(n);
  for (std::size_t i = 0; i < n; ++i) rooms.of_patch[i] = number[label[i]];
  return rooms;
}

}  // namespace clerestory
