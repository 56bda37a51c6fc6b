#include "solver/evaluate/light_laws.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "solver/illumination/direct.h"
#include "solver/illumination/illumination.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/sampling/unit_square.h"
#include "solver/visibility/echoes.h"

namespace clerestory {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// Largest finite value of each room.
class Largest {
 public:
  explicit Largest(std::size_t rooms) : of_room_(rooms, 0.0) {}
  void see(std::size_t room, double value) {
    if (std::isfinite(value)) of_room_[room] = std::max(of_room_[room], value);
  }
  double at(std::size_t room) const { return of_room_[room]; }

 private:
  std::vector<double> of_room_;
};

/// A sum that is estimated.
struct Estimate {
  double value = 0, variance = 0;
  double of_variance = 0;  ///< sum of squares of the variances that were each found by one difference
};

/// So many standard errors of a normal distribution are how many where the error itself was found by `freedom`
/// differences. Source: Wallace, "Bounds on normal approximations to Student's and the chi-square distributions", 1959.
double student(double std_errors, double freedom) {
  const double z = std_errors * (8 * freedom + 3) / (8 * freedom + 1);
  return std::sqrt(freedom * std::expm1(z * z / freedom));
}

/// What an estimate of these parts may be off by.
double unsure(const Estimate& a, const Estimate& b, double std_errors) {
  const double variance = a.variance + b.variance, of_variance = a.of_variance + b.of_variance;
  if (variance == 0) return 0;
  const double factor =
      of_variance > 0 ? student(std_errors, std::max(1.0, variance * variance / of_variance)) : std_errors;
  return factor * std::sqrt(variance);
}

/// What the lights bring to each room [W]. The two halves of the rays differ by what they leave open.
std::vector<Estimate> direct_flux(const Problem& problem, std::uint64_t seed, const Monitor& monitor) {
  const PatchSet& patches = problem.patches;
  std::vector<Estimate> flux(patches.room_count());
  const Illumination light(problem);
  if (light.sky.dark() && problem.lights.suns.empty() && problem.lights.luminaires.empty()) return flux;
  const auto half = [&](std::uint64_t number) {
    return direct_light(light,
                        {.shadow_rays = 16,
                         .edge_rays = 64,
                         .sky_rays = 64,
                         .seed = stream_key(seed, kLawDirect, number),
                         .rough_first = false},
                        monitor)
        .E;
  };
  const Field a = half(0), b = half(1);
  for (std::size_t i = 0; i < patches.patch_count(); ++i) {
    const double x = patches.area[i] * luminous_mean(a[i]), y = patches.area[i] * luminous_mean(b[i]);
    Estimate& room = flux[patches.room_of(i)];
    room.value += (x + y) / 2;
    const double variance = (x - y) * (x - y) / 4;
    room.variance += variance, room.of_variance += variance * variance;
  }
  return flux;
}

/// The patches of a room by the flux that they send.
struct Sender {
  std::vector<std::uint32_t> patch;
  std::vector<double> up_to;  ///< flux of the patches so far [W]
  double flux() const { return up_to.empty() ? 0 : up_to.back(); }
};

std::vector<Sender> senders(const PatchSet& patches, const Field& B) {
  std::vector<Sender> rooms(patches.room_count());
  for (std::size_t i = 0; i < patches.patch_count(); ++i) {
    const double flux = patches.area[i] * luminous_mean(B[i]);
    if (!(flux > 0)) continue;
    Sender& room = rooms[patches.room_of(i)];
    room.up_to.push_back(room.flux() + flux);
    room.patch.push_back(static_cast<std::uint32_t>(i));
  }
  return rooms;
}

/// Rays of each room: most where most light is, and enough where there is little. A whole power of two each, so that
/// their strata are complete.
std::size_t rays_of(const Sender& room, double root_of_all) {
  constexpr double kLeast = 4096, kAll = 1 << 18;
  const double share = root_of_all > 0 ? std::sqrt(room.flux()) / root_of_all : 0;
  return std::size_t{1} << std::lround(std::log2(std::max(kLeast, share * kAll)));
}

struct Landed {
  std::uint32_t room;
  float share;  ///< of the ray's flux; 0: it was lost
};

/// Where rays of a room land that carry equal parts of its flux.
std::vector<Landed> cast(const Problem& problem, const Field& B, const Sender& room, std::size_t rays,
                         std::uint64_t key) {
  const PatchSet& patches = problem.patches;
  std::vector<Landed> landed(rays);
  parallel_for(rays, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      RandomStream random(stream_key(key, k));
      const double at = (static_cast<double>(k) + random.uniform()) / static_cast<double>(rays) * room.flux();
      const auto place = std::ranges::upper_bound(room.up_to, at) - room.up_to.begin();
      const std::size_t i = room.patch[std::min(static_cast<std::size_t>(place), room.patch.size() - 1)];
      const auto u = sobol4(static_cast<std::uint32_t>(k), key);
      const Frame frame(patches.normal[i]);
      const Vec3 from = point_on_triangle(patches.corner_positions(PatchId{i}), u[2], u[3]);
      const Ray ray{problem.rays.off_surface(from, frame.n), cosine_direction(frame, u[0], u[1])};
      const Hit hit = one_way(problem.rays, patches, ray, random);
      if (!hit.patch.valid()) continue;
      landed[k] = {static_cast<std::uint32_t>(patches.room_of(hit.patch.value)),
                   static_cast<float>(luminous_mean(hit.transmittance * B[i]) / luminous_mean(B[i]))};
    }
  });
  return landed;
}

/// Adds to each room what the rays of one carry there. A room that few of them found may get as much as a few more
/// would bring.
void add_landed(const std::vector<Landed>& landed, double flux, std::vector<Estimate>& arrives) {
  constexpr double kFew = 10;
  const double n = static_cast<double>(landed.size()), each = flux / n;
  std::vector<double> sum(arrives.size()), square(arrives.size());
  for (const Landed& ray : landed)
    sum[ray.room] += double{ray.share}, square[ray.room] += double{ray.share} * ray.share;
  for (std::size_t r = 0; r < arrives.size(); ++r) {
    arrives[r].value += each * sum[r];
    arrives[r].variance += each * each * (square[r] - sum[r] * sum[r] / n + (sum[r] < kFew ? 1 : 0));
  }
}

}  // namespace

LawCheck no_negative_light(const PatchSet& patches, const VertexLightmap& lightmap, const Solution& solution) {
  constexpr double kRounding = 1e-4;
  Largest largest(patches.room_count());
  for (std::size_t i = 0; i < solution.E.size(); ++i) largest.see(patches.room_of(i), solution.E[i].max());
  for (std::size_t p = 0; p < lightmap.E.size(); ++p)
    largest.see(patches.room_of(lightmap.patch_of_point[p]), lightmap.E[p].max());
  WorstInRooms worst(patches.rooms);
  const auto see = [&](std::size_t room, const Spectrum& E) {
    const double below = all_finite(E) ? std::max(0.0, -E.min()) : kNoNumber;
    worst.see(room, below == 0 ? 0 : below / largest.at(room), kRounding);
  };
  for (std::size_t i = 0; i < solution.E.size(); ++i) see(patches.room_of(i), solution.E[i]);
  for (std::size_t p = 0; p < lightmap.E.size(); ++p) see(patches.room_of(lightmap.patch_of_point[p]), lightmap.E[p]);
  return {Law::no_negative_light, worst.rooms(), {}};
}

LawCheck radiosity_from_irradiance(const PatchSet& patches, const Solution& solution) {
  constexpr double kRounding = 1e-9;
  Largest largest(patches.room_count());
  for (std::size_t i = 0; i < solution.B.size(); ++i) largest.see(patches.room_of(i), solution.B[i].max());
  WorstInRooms worst(patches.rooms);
  for (std::size_t i = 0; i < solution.B.size(); ++i) {
    const Spectrum rest = solution.B[i] - patches.M[i] - patches.scattered(solution.E, i);
    const double off = all_finite(rest) ? std::max(rest.max(), -rest.min()) : kNoNumber;
    worst.see(patches.room_of(i), off == 0 ? 0 : off / largest.at(patches.room_of(i)), kRounding);
  }
  return {Law::radiosity, worst.rooms(), {}};
}

LawCheck energy_of_rooms(const Problem& problem, const Problem& unhalved, const Solution& solution, double accuracy,
                         std::uint64_t seed, const Monitor& monitor) {
  constexpr double kStdErrors = 4;    // one in 16,000 by chance
  constexpr double kResolved = 0.25;  // of a room's light
  const PatchSet& patches = problem.patches;
  std::vector<Estimate> arrives = direct_flux(unhalved, seed, monitor);
  const std::vector<Sender> rooms = senders(patches, solution.B);
  const double root_of_all = std::accumulate(rooms.begin(), rooms.end(), 0.0,
                                             [](double sum, const Sender& s) { return sum + std::sqrt(s.flux()); });
  for (std::size_t r = 0; r < rooms.size(); ++r) {
    if (monitor.should_stop()) return {Law::energy, {}, "there was no time"};
    if (rooms[r].flux() > 0)
      add_landed(cast(problem, solution.B, rooms[r], rays_of(rooms[r], root_of_all), stream_key(seed, kLawRays, r)),
                 rooms[r].flux(), arrives);
  }
  std::vector<Estimate> found(arrives.size());
  for (std::size_t i = 0; i < solution.E.size(); ++i) {
    Estimate& room = found[patches.room_of(i)];
    room.value += patches.area[i] * luminous_mean(solution.E[i]);
    if (solution.std_error.size() > 0)
      room.variance += std::pow(patches.area[i] * luminous_mean(solution.std_error[i]), 2);
  }

  WorstInRooms worst(patches.rooms);
  for (std::size_t r = 0; r < found.size(); ++r) {
    const double E = found[r].value, off = std::abs(E - arrives[r].value);
    const double left_open = unsure(arrives[r], found[r], kStdErrors);
    const double all = E > 0 ? E : arrives[r].value;
    if (all == 0) continue;  // dark
    worst.see(r, off / all, accuracy + left_open / all, !std::isfinite(E) || left_open <= kResolved * all);
  }
  LawCheck check{Law::energy, worst.rooms(), {}};
  check.rooms.push_back({"whole scene", std::abs(solution.energy.imbalance()), accuracy});
  return check;
}

}  // namespace clerestory
