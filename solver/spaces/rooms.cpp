#include "solver/spaces/rooms.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <map>
#include <numeric>
#include <set>

#include "solver/model/box.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/openings/openings.h"
#include "solver/sampling/unit_square.h"

namespace clerestory {
namespace {

/// So many of the largest patches tell what the rooms are, and with how many rays; the others find out where they are.
constexpr std::size_t kDeciding = 1 << 14, kRays = 1 << 17, kFewestRays = 8, kMostRays = 32, kRaysOfOthers = 4;
constexpr int kSweeps = 24;
/// So long those that have a name, and the open air, have no vote: all of one label at once, they would run through a
/// door while those behind it still have a label each.
constexpr int kSweepsAlone = 6;
constexpr double kLeastRoom = 1e-3;  ///< of all area: what is smaller and has no name is no room of its own
/// Two groups are one room when the smaller one sends more of its light to the other, or less to itself.
constexpr double kMostBetween = 0.1, kLeastWithin = 0.5;

constexpr std::uint32_t kNone = 0xffffffff;

/// What rays from some patches meet.
struct Views {
  struct Meeting {
    std::uint32_t what = kNone;  ///< a patch, or the number after the last one for the open air
    bool parted = false;         ///< by glass, a mirror or an opening
  };
  std::size_t rays = 0;           ///< of each
  std::vector<Meeting> meetings;  ///< in the order of the patches
};

/// Who sees whom among the patches that decide and the open air, which is the last: symmetric.
struct Sight {
  struct Edge {
    std::uint32_t other;
    float weight;  ///< area over rays [m2]
    bool parted;
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

Views look_around(const Problem& problem, std::span<const std::uint32_t> from, std::size_t rays,
                  const Monitor& monitor) {
  const PatchSet& patches = problem.patches;
  const auto air = static_cast<std::uint32_t>(patches.patch_count());
  const bool has_open_air = problem.lights.sky || !problem.lights.suns.empty();
  std::vector<OpeningSphere> spheres;
  for (const LightArea& opening : problem.lights.sky_openings()) spheres.emplace_back(opening);
  Views views{rays, std::vector<Views::Meeting>(from.size() * rays)};
  parallel_for(from.size(), 32, [&](std::size_t begin, std::size_t end) {
    std::vector<Ray> around(rays);
    std::vector<Hit> hits(rays);
    for (std::size_t i = begin; i < end && !monitor.is_interrupted(); ++i) {
      const PatchId patch{std::size_t{from[i]}};
      const Frame frame(patches.normal[patch]);
      const auto corners = patches.corner_positions(patch);
      const std::uint64_t key = stream_key(kRoomRays, from[i]);
      for (std::size_t k = 0; k < rays; ++k) {
        const auto u = sobol4(static_cast<std::uint32_t>(k), key);
        const Vec3 p = problem.rays.off_surface(point_on_triangle(corners, u[2], u[3]), frame.n);
        around[k] = {p, cosine_direction(frame, u[0], u[1])};
      }
      problem.rays.first_hits(patches, around, hits);
      for (std::size_t k = 0; k < rays; ++k) {
        const Hit& hit = hits[k];
        if (hit.escaped() ? !has_open_air : !hit.patch.valid()) continue;
        const double distance = hit.escaped() ? problem.rays.diameter() : hit.distance;
        views.meetings[i * rays + k] = {hit.escaped() ? air : hit.patch.value,
                                        hit.reflected || hit.transmittance != Spectrum(1.0) ||
                                            passes_an_opening(problem, spheres, around[k], distance)};
      }
    }
  });
  return views;
}

/// place  of each patch, and of the open air behind them, among those that decide; kNone: it does not.
Sight sight_of(const PatchSet& patches, std::span<const std::uint32_t> deciding, std::span<const std::uint32_t> place,
               const Views& views) {
  Sight sight;
  sight.begin.assign(deciding.size() + 2, 0);
  const auto visit = [&](const auto& found) {
    for (std::size_t r = 0; r < views.meetings.size(); ++r) {
      const auto& [what, parted] = views.meetings[r];
      if (what != kNone && place[what] != kNone) found(static_cast<std::uint32_t>(r / views.rays), place[what], parted);
    }
  };
  visit([&](std::uint32_t a, std::uint32_t b, bool) { ++sight.begin[a], ++sight.begin[b]; });
  std::exclusive_scan(sight.begin.begin(), sight.begin.end(), sight.begin.begin(), std::size_t{0});
  sight.edges.resize(sight.begin.back());
  std::vector<std::size_t> next(sight.begin.begin(), sight.begin.end() - 1);
  visit([&](std::uint32_t a, std::uint32_t b, bool parted) {
    const auto weight = static_cast<float>(patches.area[deciding[a]] / static_cast<double>(views.rays));
    sight.edges[next[a]++] = {b, weight, parted};
    sight.edges[next[b]++] = {a, weight, parted};
  });
  return sight;
}

/// Each takes the label that most of what it sees has.
std::vector<std::uint32_t> hand_labels_on(const Sight& sight, std::vector<std::uint32_t> label,
                                          const std::vector<bool>& is_fixed) {
  std::vector<std::uint32_t> order(sight.size());
  std::iota(order.begin(), order.end(), 0u);
  std::vector<double> votes(label.empty() ? 0 : *std::ranges::max_element(label) + 1, 0);
  std::vector<std::uint32_t> voted;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    // Another order each time: with one order, a label could run through all that follow each other.
    RandomStream random(kRoomOrder, static_cast<std::uint64_t>(sweep));
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
    std::set<std::uint32_t> were_joined;
    for (const auto& [sum, l] : by_size) {
      const auto found = best.find(l);
      if (found == best.end() || found->second.weight <= 0 || were_joined.contains(l)) continue;
      if (is_named[l]) {  // what a name was given to but a part of takes the name
        const std::uint32_t whole = found->second.other;
        if (l == air || is_named[whole] || joins.contains(whole) || were_joined.contains(whole)) continue;
        joins[whole] = l;
        were_joined.insert(l);
        continue;
      }
      if (joins.contains(found->second.other)) continue;
      joins[l] = found->second.other;
      were_joined.insert(found->second.other);
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

/// Share of the rays from all over a patch that meet nothing.
double share_that_escapes(const Problem& problem, std::size_t i) {
  constexpr std::uint32_t kRaysOfSide = 64;
  const Vec3 n = problem.patches.normal[i];
  const Frame frame(n);
  const auto corners = problem.patches.corner_positions(PatchId{i});
  int escaped = 0;
  for (std::uint32_t k = 0; k < kRaysOfSide; ++k) {
    const auto u = sobol4(k, stream_key(kRoomSides, i));
    const Vec3 p = problem.rays.off_surface(point_on_triangle(corners, u[0], u[1]), n);
    escaped += problem.rays.first_hit(problem.patches, {p, cosine_direction(frame, u[2], u[3])}).escaped();
  }
  return escaped / double{kRaysOfSide};
}

/// A wall of a single sheet that a room is named by has the room on one side only: the other, which looks more into the
/// open, loses the name.
void unname_outer_sides(const Problem& problem, std::size_t first, std::vector<std::uint32_t>& room) {
  constexpr double kMore = 0.25;
  const PatchSet& patches = problem.patches;
  std::vector<std::uint8_t> open(room.size());
  parallel_for(room.size(), 64, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      if (room[i] == kNone || room[i] < first) continue;
      const PatchId other = patches.side_patch[patches.triangle[i]][patches.side[i] == kFront ? kBack : kFront];
      if (!other.valid() || room[other] != room[i]) continue;
      open[i] = share_that_escapes(problem, i) > share_that_escapes(problem, other.value) + kMore;
    }
  });
  for (std::size_t i = 0; i < room.size(); ++i)
    if (open[i]) room[i] = kNone;
}

/// The named room of each patch, or kNone.
std::vector<std::uint32_t> named_room_of(const Problem& problem, const NamedRooms& named) {
  const PatchSet& patches = problem.patches;
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
  unname_outer_sides(problem, named.spaces.size(), room);
  return room;
}

/// What most of these meetings have, of those that nothing parts if there are any.
std::uint32_t seen_most(std::span<const Views::Meeting> meetings, std::span<const std::uint32_t> place,
                        std::span<const std::uint32_t> label, std::uint32_t none) {
  std::uint32_t best = none;
  int most = 0;
  for (const auto& [what, parted] : meetings) {
    if (what == kNone || place[what] == kNone) continue;
    int votes = parted ? 0 : 100;
    for (const auto& [other, is_parted] : meetings)
      votes +=
          other != kNone && place[other] != kNone && is_parted == parted && label[place[other]] == label[place[what]];
    if (votes > most) best = label[place[what]], most = votes;
  }
  return best;
}

/// Numbers and names of the rooms.
///
/// label  of each patch: a named room, the open air, any room, or `small`, which is the last.
Rooms numbered(const PatchSet& patches, const NamedRooms& named, std::vector<std::uint32_t> label,
               const std::vector<bool>& is_named, std::uint32_t air, std::uint32_t small) {
  // The insides of frames and the gaps behind them are told together.
  const std::size_t n = patches.patch_count();
  std::vector<double> area(small + 1, 0);
  for (std::size_t i = 0; i < n; ++i) area[label[i]] += patches.area[i];
  const double least = kLeastRoom * patches.total_area();
  for (std::size_t i = 0; i < n; ++i)
    if (label[i] != small && !is_named[label[i]] && area[label[i]] < least)
      area[small] += patches.area[i], label[i] = small;
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
    rooms.names.push_back(l == air                  ? kOutdoors
                          : l == small              ? kSmallerSpaces
                          : l < named.spaces.size() ? named.spaces[l].name
                          : l < air                 ? named.by_surface[l - named.spaces.size()].name
                                                    : kUnnamedRoom + std::to_string(++nameless));
  }
  rooms.of_patch.resize(n);
  for (std::size_t i = 0; i < n; ++i) rooms.of_patch[i] = number[label[i]];
  return rooms;
}

}  // namespace

Rooms find_rooms(const Problem& problem, const NamedRooms& named, const Monitor& monitor) {
  const PatchSet& patches = problem.patches;
  const std::size_t n = patches.patch_count(), named_count = named.spaces.size() + named.by_surface.size();
  std::vector<std::uint32_t> deciding(n), others;
  std::iota(deciding.begin(), deciding.end(), 0u);
  if (n > kDeciding) {
    std::ranges::stable_sort(deciding, std::greater<>(), [&](std::uint32_t i) { return patches.area[i]; });
    others.assign(deciding.begin() + kDeciding, deciding.end());
    deciding.resize(kDeciding);
  }
  std::vector<std::uint32_t> place(n + 1, kNone);
  for (std::uint32_t k = 0; k < deciding.size(); ++k) place[deciding[k]] = k;
  place[n] = static_cast<std::uint32_t>(deciding.size());

  // Labels: those with names, then the open air, then one for each patch that decides.
  const auto air = static_cast<std::uint32_t>(named_count);
  const std::vector<std::uint32_t> name = named_room_of(problem, named);
  std::vector<std::uint32_t> label;
  std::vector<bool> is_fixed, is_named(deciding.size() + named_count + 1);
  for (std::uint32_t k = 0; k < deciding.size(); ++k) {
    is_fixed.push_back(name[deciding[k]] != kNone);
    label.push_back(is_fixed[k] ? name[deciding[k]] : air + 1 + k);
  }
  label.push_back(air);
  is_fixed.push_back(true);
  for (std::size_t l = 0; l <= named_count; ++l) is_named[l] = true;
  const std::size_t rays =
      std::bit_floor(std::clamp(kRays / std::max<std::size_t>(deciding.size(), 1), kFewestRays, kMostRays));
  const Sight sight = sight_of(patches, deciding, place, look_around(problem, deciding, rays, monitor));
  label = hand_labels_on(sight, std::move(label), is_fixed);
  join_labels(sight, label, is_named, air);

  const auto small = static_cast<std::uint32_t>(is_named.size());
  std::vector<std::uint32_t> label_of(n, small);
  for (std::uint32_t k = 0; k < deciding.size(); ++k) label_of[deciding[k]] = label[k];
  const Views of_others = look_around(problem, others, kRaysOfOthers, monitor);
  for (std::size_t k = 0; k < others.size(); ++k)
    label_of[others[k]] =
        name[others[k]] != kNone
            ? name[others[k]]
            : seen_most(std::span(of_others.meetings).subspan(k * kRaysOfOthers, kRaysOfOthers), place, label, small);
  return numbered(patches, named, std::move(label_of), is_named, air, small);
}

}  // namespace clerestory
