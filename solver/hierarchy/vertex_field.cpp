#include "solver/hierarchy/vertex_field.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "solver/gather/gather_point.h"
#include "solver/gather/gather_time.h"
#include "solver/hierarchy/feet.h"
#include "solver/hierarchy/fine_radiosity.h"
#include "solver/hierarchy/leaf_errors.h"
#include "solver/illumination/caustic_light.h"
#include "solver/lights/luminaire.h"
#include "solver/model/parallel.h"
#include "solver/model/units.h"
#include "solver/paths/find_slit_gains.h"

namespace clerestory {
namespace {

constexpr int kMostRounds = 40;
/// Points gathered after halving, as a share of those there were before, that a quality must leave time for.
constexpr double kPointsOfHalves = 0.5;
constexpr double kPointsOfHalf = 2;  ///< that halving an element makes at most, as its neighbours are halved with it
/// Where light that is not straight from sun and luminaires is off by more than so many times the tolerance, edges may
/// be shorter than the shortest in proportion, down to that share of it: at the feet of furniture and in window
/// reveals.
constexpr double kMuchOff = 2, kFinest = 0.25;
/// Error of a room that is aimed at, relative to the mean, in tolerances: by what elements are off at most, in the
/// middle of an edge, twice what they are. Shares of the shortest edge that they may have for it.
constexpr double kOfRoom = 1, kFinestForRoom = 1.0 / 32;
/// Shortest edges: so far off the pilot rays of a point tell enough, where it has nearly the same horizon (cosine).
constexpr double kNearby = 4, kSameHorizon = 0.95;
/// Of the sun and luminaires at the point that sent them: where there is less, what is little beside them is not.
constexpr double kInShade = 0.5;
/// Shortest edges, for each share of the tolerance: points so near each other have the same light, but for sun and
/// luminaires. Detail far below what elements resolve.
constexpr double kSamePlace = 2.5;
/// Points of the field, times those there were before, that look-ups are told of.
constexpr double kWorthTaking = 1.3;

/// The points of the mesh that are worth a gather: all, or so many, those of the largest elements.
std::vector<bool> worth_a_gather(const ElementMesh& mesh, std::size_t most) {
  const std::size_t points = mesh.points().position.size();
  if (points <= most) return std::vector<bool>(points, true);
  std::vector<float> largest(points, 0);
  for (const std::uint32_t leaf : mesh.leaves())
    for (const std::uint32_t p : mesh.points_of(leaf))
      largest[p] = std::max(largest[p], static_cast<float>(mesh[leaf].area));
  std::vector<float> sorted = largest;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(most), sorted.end(), std::greater<>());
  std::vector<bool> worth(points);
  for (std::size_t p = 0; p < points; ++p) worth[p] = largest[p] > sorted[most];
  return worth;
}

/// What suns give at most, and luminaires whose whole flux falls on one of the smallest elements: a point that a
/// luminaire touches must not outshine the room [W/m2].
double most_delta_light(const Problem& problem, double shortest_edge) {
  double flux = 0, sun = 0;
  for (const Luminaire& luminaire : problem.lights.luminaires) flux += luminous_mean(power(luminaire));
  for (const Sun& s : problem.lights.suns) sun += luminous_mean(s.normal_irradiance);
  const double smallest = shortest_edge * shortest_edge / 4;  // half of a square of half the edge or more
  return flux > 0 ? sun + flux / smallest : std::numeric_limits<double>::infinity();
}

/// For each point worth a gather one that stands for it: itself, or another on the same surface that is no further off
/// than that and whose normal is no more off than by that cosine.
///
/// edges  shortest edges; times of them is the distance.
std::vector<std::uint32_t> stand_ins(const ElementMesh& mesh, const std::vector<bool>& worth, const ShortestEdge& edges,
                                     double times, double cosine) {
  const VertexLightmap& at = mesh.points();
  std::vector<std::uint32_t> stand_in(at.position.size(), VertexLightmap::kNone);
  const auto serves = [&](std::uint32_t q, std::uint32_t p, double distance) {
    return q != VertexLightmap::kNone && length(at.position[q] - at.position[p]) <= distance &&
           dot(at.sample_normal[at.sample_begin[q]], at.sample_normal[at.sample_begin[p]]) > cosine;
  };
  for (const std::uint32_t leaf : mesh.leaves()) {
    const auto point = mesh.points_of(leaf);
    const double distance = times * edges.of(mesh.patches(), mesh[leaf].patch);
    for (const std::uint32_t p : point) {
      if (!worth[p] || stand_in[p] != VertexLightmap::kNone) continue;
      stand_in[p] = p;
      for (const std::uint32_t q : point)
        if (q != p && serves(stand_in[q], p, distance)) stand_in[p] = stand_in[q];
    }
  }
  return stand_in;
}

/// What the deadline leaves time for.
GatherQuality quality_in_time(const Illumination& light, const ElementMesh& mesh, const FieldOptions& options,
                              const Monitor& monitor) {
  if (!monitor.has_deadline()) return options.quality;
  std::vector<GatherQuality> qualities{options.quality};
  qualities.insert(qualities.end(), options.coarser.begin(), options.coarser.end());
  const VertexLightmap& at = mesh.points();
  const Gathers gathers{std::min(at.sample_position.size(), options.most_points),
                        sample_points(at, light.problem.rays)};
  return quality_in_time(light, gathers, qualities, monitor.seconds_left() / (1 + kPointsOfHalves), options.seed);
}

/// Gathers at points that are new since the last time, in parallel.
class Gatherer {
 public:
  Gatherer(Illumination light, const ElementMesh& mesh, const FieldOptions& options, const RowLight* layers,
           const Monitor& monitor)
      : light_(std::move(light)),
        pattern_(quality_in_time(light_, mesh, options, monitor), options.seed),
        mesh_(mesh),
        pilots_(wants_plan(light_, pattern_)),
        layers_(layers),
        most_delta_(most_delta_light(light_.problem, options.shortest_edge.least())),
        worth_(worth_a_gather(mesh, options.most_points)),
        plans_(pilots_ ? mesh.points().position.size() : 0) {
    if (pilots_) pilot_of_ = stand_ins(mesh, worth_, options.shortest_edge, kNearby, kSameHorizon);
    same_as_ = stand_ins(mesh, worth_, options.shortest_edge, kSamePlace * options.tolerance, VertexLightmap::kAlike);
  }

  bool is_coarser_than(const GatherQuality& quality) const {
    return pattern_.quality().bundle.rays < quality.bundle.rays;
  }

  /// False when the monitor stopped it.
  bool gather(VertexField& field, const Monitor& monitor) {
    const VertexLightmap& at = mesh_.points();
    const std::size_t begin = field.known.size(), end = at.position.size();
    const int channels = light_.problem.patches.channels;
    field.E.value.resize(end * static_cast<std::size_t>(channels));
    field.delta_light.value.resize(field.E.value.size());
    for (Field* lanes : {&field.layers, &field.delta_layers})
      if (layers_) lanes->value.resize(end * layers_->lanes());
    field.std_error.resize(end);
    field.known.resize(end);
    for (std::size_t p = pilot_of_.size(); p < end && pilots_; ++p) pilot_of_.push_back(pilot_of_[mesh_.ends(p)[0]]);
    std::vector<std::uint32_t> pilots, others, alike;
    for (std::size_t p = begin; p < end; ++p) {
      if (p < worth_.size() && !worth_[p]) continue;
      const bool is_pilot = pilots_ && pilot_of_[p] == p;
      (is_pilot ? pilots : takes_from_another(p) ? alike : others).push_back(static_cast<std::uint32_t>(p));
    }
    const auto gather = [&](std::size_t p, LightRow& row, unsigned long long& rays) { gather_at(p, field, row, rays); };
    const auto take = [&](std::size_t p, LightRow& row, unsigned long long&) { take_light(p, field, row); };
    field.alike += alike.size();
    const bool complete = at_each(pilots, field, monitor, gather) && at_each(others, field, monitor, gather) &&
                          at_each(alike, field, monitor, take);
    if (!light_.problem.lights.caustics.legs.empty()) add_caustics(begin, field);
    return complete;
  }

 private:
  /// At points from that number on.
  void add_caustics(std::size_t begin, VertexField& field) const {
    const VertexLightmap& at = mesh_.points();
    const std::uint32_t first = at.sample_begin[begin], count = at.sample_begin.back() - first;
    const CausticIrradiance found = caustic_irradiance(
        light_.problem, count,
        [&](std::size_t k) {
          const Vec3 n = at.sample_normal[first + k];
          return ReceivingPoint{light_.problem.rays.off_surface(at.sample_position[first + k], n), n};
        },
        layers_ != nullptr);
    for (std::size_t p = begin; p < field.known.size(); ++p) {
      if (!field.known[p]) continue;
      double variance = field.std_error[p] * field.std_error[p];
      for (std::uint32_t s = at.sample_begin[p]; s < at.sample_begin[p + 1]; ++s) {
        const double weight = at.sample_weight[s];
        field.E.add(p, found.E[s - first] * weight), field.delta_light.add(p, found.E[s - first] * weight);
        variance += weight * weight * found.variance[s - first];
        if (!layers_) continue;
        LightRow row = found.rows[s - first];
        for (RowEntry& entry : row) entry.scale(Spectrum(weight));
        for (Field* lanes : {&field.layers, &field.delta_layers}) layers_->add(row, lanes_of(*lanes, p).data());
      }
      field.std_error[p] = std::sqrt(variance);
    }
  }

  /// Of two points of one place on a flat face, no middles.
  bool takes_from_another(std::size_t p) const {
    if (p >= same_as_.size() || same_as_[p] == p) return false;
    const std::vector<std::uint32_t>& begin = mesh_.points().sample_begin;
    const auto is_flat = [&](std::size_t q) { return begin[q + 1] - begin[q] == 1; };
    return is_flat(p) && is_flat(same_as_[p]);
  }

  template <class Visit>
  bool at_each(std::span<const std::uint32_t> points, VertexField& field, const Monitor& monitor, const Visit& visit) {
    constexpr std::size_t kBlock = 1024;
    const auto gathered =
        parallel_blocks(points.size(), kBlock, 16, "vertices", monitor, [&](std::size_t from, std::size_t to) {
          unsigned long long rays = 0;
          LightRow row;
          for (std::size_t k = from; k < to; ++k) visit(points[k], row, rays);
          return rays;
        });
    for (const std::uint32_t p : points.first(gathered.done)) field.known[p] = true;
    field.rays += gathered.rays;
    return gathered.done == points.size();
  }

  void gather_at(std::size_t p, VertexField& field, LightRow& row, unsigned long long& rays) {
    const VertexLightmap& at = mesh_.points();
    GatheredLight mean;
    for (std::uint32_t s = at.sample_begin[p]; s < at.sample_begin[p + 1]; ++s) {
      const Vec3 n = at.sample_normal[s], x = light_.problem.rays.off_surface(at.sample_position[s], n);
      if (pilots_ && pilot_of_[p] == p && !plans_[p]) plans_[p] = plan_gather(light_, x, n, pattern_, rays);
      static const GatherPlan kNone;
      const GatherPlan& plan = pilots_ ? *plans_[pilot_of_[p]] : kNone;
      GatheredLight here = gather_point(light_, x, n, pattern_, plan, rays, layers_ ? &row : nullptr);
      if (luminous_mean(here.delta_light) < kInShade * plan.delta_light)
        here = gather_point(light_, x, n, pattern_, rays, layers_ ? &row : nullptr);
      if (layers_)
        add_layers(here, row, *layers_, at.sample_weight[s], lanes_of(field.layers, p),
                   lanes_of(field.delta_layers, p));
      mean.E += here.E * at.sample_weight[s];
      mean.delta_light += here.delta_light * at.sample_weight[s];
      mean.std_error += here.std_error * at.sample_weight[s];
    }
    keep_to_most_delta(mean, p, field);
    field.E.set(p, mean.E);
    field.delta_light.set(p, mean.delta_light);
    field.std_error[p] = mean.std_error;
  }

  /// Its own sun and luminaires, all else from the point that stands for it.
  void take_light(std::size_t p, VertexField& field, LightRow& row) {
    const VertexLightmap& at = mesh_.points();
    const std::size_t s = at.sample_begin[p], q = same_as_[p];
    GatheredLight here;
    if (!light_.problem.lights.empty()) {
      row.clear();
      const Vec3 n = at.sample_normal[s], x = light_.problem.rays.off_surface(at.sample_position[s], n);
      here.E = here.delta_light =
          light_.sampler.delta_light(x, n, delta_effort(pattern_), pattern_.sun_key(), layers_ ? &row : nullptr);
      if (layers_) add_layers(here, row, *layers_, 1, lanes_of(field.layers, p), lanes_of(field.delta_layers, p));
      keep_to_most_delta(here, p, field);
    }
    for (int c = 0; c < kMaxChannels; ++c) here.E[c] += std::max(0.0, field.E[q][c] - field.delta_light[q][c]);
    field.E.set(p, here.E);
    field.delta_light.set(p, here.delta_light);
    field.std_error[p] = field.std_error[q];
    if (!layers_) return;
    const auto to = lanes_of(field.layers, p), all = lanes_of(field.layers, q), part = lanes_of(field.delta_layers, q);
    for (std::size_t l = 0; l < to.size(); ++l) to[l] += all[l] - part[l];
  }

  void keep_to_most_delta(GatheredLight& mean, std::size_t p, VertexField& field) const {
    const double delta = luminous_mean(mean.delta_light);
    if (!(delta > most_delta_)) return;
    const double too_much = 1 - most_delta_ / delta;
    mean.E = mean.E - mean.delta_light * too_much;
    mean.delta_light *= 1 - too_much;
    if (!layers_) return;
    const std::span<double> all = lanes_of(field.layers, p), part = lanes_of(field.delta_layers, p);
    for (std::size_t l = 0; l < part.size(); ++l) all[l] -= too_much * part[l], part[l] *= 1 - too_much;
  }

  const Illumination light_;
  const GatherPattern pattern_;
  const ElementMesh& mesh_;
  bool pilots_;
  const RowLight* layers_;
  double most_delta_;                    ///< of delta light at a point, luminous mean [W/m2]
  std::vector<bool> worth_;              ///< by point of the mesh as it was at first
  std::vector<std::uint32_t> pilot_of_;  ///< by point: the one that sent a pilot for it
  std::vector<std::uint32_t> same_as_;   ///< by point of the mesh as it was at first: the one that it takes after
  std::vector<std::optional<GatherPlan>> plans_;  ///< by point of the mesh as it was at first
};

struct Candidate {
  double error;  ///< what it adds to a RMS error of its room [1]
  std::uint32_t leaf;
};

/// Leaves that interpolate worse than the tolerance, and those whose light makes most of the error of a room, relative
/// to the room's mean, until that is within the tolerance: a sill in the sun may be within 5 % and as far off as all of
/// the room is bright.
class TooCoarse {
 public:
  TooCoarse(const ElementMesh& mesh, const VertexField& field, const FieldOptions& options)
      : mesh_(mesh), options_(options), errors_(mesh, field) {}

  /// As the field and the mesh are now, the worst first.
  std::vector<Candidate> find() {
    relative_.resize(mesh_.size()), of_mean_.resize(mesh_.size());
    for (const LeafError& e : errors_.of_changed()) {
      relative_[e.leaf] = is_worth_halving(e) ? static_cast<float>(e.relative) : 0;
      of_mean_[e.leaf] = may_be_halved_for_room(e) ? static_cast<float>(e.of_mean) : 0;
    }
    const std::vector<std::uint32_t> leaves = mesh_.leaves();
    const std::vector<double> least = least_for_rooms(leaves);
    std::vector<Candidate> worst;
    for (const std::uint32_t leaf : leaves) {
      const double of_mean = of_mean_[leaf] > least[room_of(leaf)] ? of_mean_[leaf] : 0;
      if (const double error = std::max<double>(relative_[leaf], of_mean); error > 0) worst.push_back({error, leaf});
    }
    std::sort(worst.begin(), worst.end(), [](const Candidate& a, const Candidate& b) {
      return a.error != b.error ? a.error > b.error : a.leaf < b.leaf;
    });
    return worst;
  }

 private:
  std::uint32_t room_of(std::uint32_t leaf) const { return mesh_.patches().room_of(mesh_[leaf].patch); }
  bool is_worth_halving(const LeafError& e) const {
    const double much = e.soft / (options_.tolerance * e.E);
    return is_longer(e.leaf, std::clamp(kMuchOff / much, kFinest, 1.0)) &&
           e.off > std::max(options_.tolerance * e.E, e.std_error);
  }
  bool may_be_halved_for_room(const LeafError& e) const {
    return is_longer(e.leaf, kFinestForRoom) && e.soft > e.std_error;
  }
  /// Than that share of the shortest edge; what comes through a slit falls on less than any element.
  bool is_longer(std::uint32_t leaf, double share) const {
    const std::uint32_t patch = mesh_[leaf].patch;
    const double shortest = options_.shortest_edge.of(mesh_.patches(), patch);
    return mesh_.longest_edge(leaf) > (mesh_.patches().has_outline(PatchId{std::size_t{patch}}) ? 1 : share) * shortest;
  }

  /// What a leaf adds if all leaves of its room add as much and together what is aimed at; infinite where they do not
  /// add more than that.
  std::vector<double> least_for_rooms(const std::vector<std::uint32_t>& leaves) const {
    std::vector<double> square(mesh_.patches().room_count()), count(square.size());
    for (const std::uint32_t leaf : leaves) {
      square[room_of(leaf)] += static_cast<double>(of_mean_[leaf]) * of_mean_[leaf];
      ++count[room_of(leaf)];
    }
    const double aim = kOfRoom * options_.tolerance;
    std::vector<double> least(square.size(), std::numeric_limits<double>::infinity());
    for (std::size_t room = 0; room < least.size(); ++room)
      if (square[room] > aim * aim) least[room] = aim / std::sqrt(count[room]);
    return least;
  }

  const ElementMesh& mesh_;
  const FieldOptions& options_;
  LeafErrors errors_;
  std::vector<float> relative_, of_mean_;  ///< by leaf, as of LeafError; 0 where it is not worth halving for it
};

/// Elements that a round may mark: about half of the points that are left, as one makes two with its neighbours; so the
/// worst are halved again before others are at all.
std::size_t marks_of_round(std::size_t points, std::size_t most) {
  constexpr std::size_t kLeastShare = 100;
  const std::size_t left = most - points;
  return std::clamp<std::size_t>(left / 4, std::min(left, most / kLeastShare + 1), left);
}

}  // namespace

VertexField gather_field(const Problem& problem, const Field& B, ElementMesh& mesh, const FieldOptions& options,
                         const Monitor& monitor, const RowLight* layers, const SlitLight& slit_light,
                         FineRadiosity* fine) {
  VertexField field;
  if (layers) field.layers.channels = field.delta_layers.channels = static_cast<int>(layers->lanes());
  if (monitor.should_stop()) {
    const std::size_t points = mesh.points().position.size();
    field.E = field.delta_light = Field(points, problem.patches.channels);
    field.std_error.resize(points), field.known.resize(points);
    if (layers) field.layers = field.delta_layers = Field(points, field.layers.channels);
    field.complete = false;
    return field;
  }
  field.E = field.delta_light = Field(0, problem.patches.channels);
  cut_at_feet(mesh, options.shortest_edge, kFinest, options.most_points);
  Illumination light = gather_illumination_by_slits(problem, B, slit_light, options.seed, monitor);
  if (fine) light.above_mean = [fine](PatchId patch, const Vec3& x) { return fine->above_mean(patch, x); };
  Gatherer gatherer(std::move(light), mesh, options, layers, monitor);
  field.in_time = !gatherer.is_coarser_than(options.quality);
  const double before = monitor.seconds_left();
  std::size_t taken = 0;
  TooCoarse too_coarse(mesh, field, options);
  for (int round = 0;; ++round) {
    field.complete = gatherer.gather(field, monitor);
    const std::size_t points = mesh.points().position.size();
    if (!field.complete || round == kMostRounds || points >= options.most_points) break;
    const double left = monitor.seconds_left(), most_in_time = static_cast<double>(points) * left / (before - left);
    std::vector<std::uint32_t> marked;
    const std::size_t most_marked = marks_of_round(points, options.most_points);
    for (const Candidate& c : too_coarse.find()) {
      if (marked.size() >= most_marked) break;
      if (monitor.has_deadline() && static_cast<double>(marked.size() + 1) > most_in_time / kPointsOfHalf) {
        field.in_time = false;
        break;
      }
      marked.push_back(c.leaf);
    }
    if (marked.empty()) break;
    if (fine && static_cast<double>(points) > kWorthTaking * static_cast<double>(taken)) {
      fine->take(field);
      taken = points;
    }
    mesh.split(marked);
  }
  return field;
}

}  // namespace clerestory
