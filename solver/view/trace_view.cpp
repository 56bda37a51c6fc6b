#include "solver/view/trace_view.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <utility>

#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/sampling/unit_square.h"
#include "solver/view/sample_pattern.h"

namespace clerestory {
namespace {

constexpr int kTileSide = 16;          // [pixel]
constexpr double kLeastWeight = 0.01;  // a way by which less would come is not followed
constexpr int kMostTurns = 16;
// Dim reflections are seen by one ray of four, which stands for all.
constexpr double kDim = 0.2;
constexpr int kOneOf = 4, kStandsForSome = -1;
constexpr std::uint32_t kGlossRays = 4;  // of a place that is seen, where its light is found by rays

/// Panes that the field is seen in: mirrors, and glass where light is shown.
std::vector<std::uint32_t> panes_that_show(const WrittenResult& result, bool is_radiance) {
  std::vector<std::uint32_t> shown;
  for (std::size_t i = 0; i < result.around.panes.size(); ++i)
    if (is_radiance || result.materials[result.around.panes[i].material].turns_rays())
      shown.push_back(static_cast<std::uint32_t>(i));
  return shown;
}

/// Whether a triangle sends nothing of what falls on it, though its material reflects: the other side of that is the
/// one that does.
bool is_black(const WrittenResult& result, std::uint32_t triangle) {
  if (result.materials[result.material[triangle]].reflectance.is_black()) return true;
  const WrittenArray &B = result.of_points.at("radiosity"), &E = result.of_points.at("irradiance");
  const auto has_some = [&](const WrittenArray& array) {
    const auto n = static_cast<std::size_t>(array.components);
    for (const std::uint32_t p : result.triangles[triangle])
      for (std::size_t k = 0; k < n; ++k)
        if (array.value[p * n + k] != 0) return true;
    return false;
  };
  return has_some(E) && !has_some(B);
}

std::vector<Vec3> normals_of_points(const WrittenResult& result,
                                    const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  std::vector<Vec3> normal(result.points.size());
  for (const auto& corners : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& at = result.points[corners[k]];
      const Vec3 u = result.points[corners[(k + 1) % 3]] - at, v = result.points[corners[(k + 2) % 3]] - at;
      const Vec3 across = cross(u, v);
      if (length(across) > 0) normal[corners[k]] += normalized(across) * std::atan2(length(across), dot(u, v));
    }
  for (Vec3& n : normal) n = normalized(n);  // of points without a facet, which nobody asks for, nonsense
  return normal;
}

std::vector<std::array<Vec3, 3>> corners_of(const WrittenResult& result, const std::vector<std::uint32_t>& panes) {
  std::vector<std::array<Vec3, 3>> corners;
  for (const std::uint32_t i : panes) corners.push_back(result.around.panes[i].corners);
  return corners;
}

std::vector<std::array<std::uint32_t, 3>> corners_of_triangles(const WrittenResult& result,
                                                               const std::vector<std::uint32_t>& shown) {
  std::vector<std::array<std::uint32_t, 3>> corners;
  corners.reserve(shown.size());
  for (const std::uint32_t i : shown) corners.push_back(result.triangles[i]);
  return corners;
}

/// The same for the same sight.
std::uint64_t key_of_sight(const Vec3& place, const Vec3& direction, int sample) {
  std::uint64_t key = stream_key(kGlossSeen, static_cast<std::uint64_t>(sample + 1));
  for (const double x : {place.x, place.y, place.z, direction.x, direction.y, direction.z})
    key = mix_bits(key ^ std::bit_cast<std::uint64_t>(x)) + 1;
  return key;
}

}  // namespace

ShownField radiance_of(const WrittenResult& result) {
  const WrittenArray& B = result.of_points.at("radiosity");
  ShownField field{B.components, B.value, true};
  for (float& value : field.of_points) value = static_cast<float>(double{value} / std::numbers::pi);
  return field;
}

ShownField radiance_of(const WrittenResult& result, const Field& E) {
  const WrittenArray &B = result.of_points.at("radiosity"), &all = result.of_points.at("irradiance");
  ShownField field{B.components, B.value, true};
  std::vector<std::uint32_t> material(result.points.size());  // points are not shared across materials
  for (std::size_t t = 0; t < result.triangles.size(); ++t)
    for (const std::uint32_t p : result.triangles[t]) material[p] = result.material[t];
  for (std::size_t i = 0; i < field.of_points.size(); ++i) {
    const std::size_t point = i / static_cast<std::size_t>(B.components);
    const double rho =
        result.materials[material[point]].reflectance[static_cast<int>(i % static_cast<std::size_t>(B.components))];
    const double less = double{B.value[i]} - rho * (double{all.value[i]} - E.value[i]);
    field.of_points[i] = static_cast<float>(std::max(0.0, less) / std::numbers::pi);
  }
  return field;
}

ShownField illuminance_of(const Field& E) {
  ShownField field{1, {}, false};
  for (std::size_t i = 0; i < E.size(); ++i) field.of_points.push_back(static_cast<float>(photometric(E[i])));
  return field;
}

ViewScene::ViewScene(const WrittenResult& result, ShownField field, std::vector<std::uint32_t> triangles)
    : result_(result),
      field_(std::move(field)),
      triangles_(corners_of_triangles(result, triangles)),
      shown_panes_(panes_that_show(result, field_.is_radiance)),
      normal_(normals_of_points(result, triangles_)),
      surfaces_(result.points, triangles_, corners_of(result, shown_panes_)) {
  std::map<std::uint32_t, int> table_of_material;
  for (const std::uint32_t i : shown_panes_) {
    const PaneTriangle& pane = result.around.panes[i];
    const Material& material = result.materials[pane.material];
    Pane& to = panes_.emplace_back();
    const auto& [a, b, c] = pane.corners;
    to.normal = normalized(cross(b - a, c - a));
    if (material.turns_rays()) {
      to.mirror = field_.is_radiance ? material.reflectance : Spectrum(1.0);
      continue;
    }
    const auto [at, is_new] = table_of_material.try_emplace(pane.material, static_cast<int>(glass_.size()));
    if (is_new) glass_.emplace_back(material.transmittance);
    to.table = at->second;
  }
  if (field_.is_radiance && std::ranges::any_of(result.materials, &Material::is_glossy)) {
    for (const Material& material : result.materials) {
      lobe_of_material_.push_back(material.is_glossy() ? static_cast<int>(lobes_.size()) : -1);
      if (material.is_glossy()) lobes_.emplace_back(*material.gloss);
    }
  }
  if (field_.is_radiance)
    for (const std::uint32_t i : triangles)
      material_.push_back(result.material[i]), is_black_.push_back(is_black(result, i));
  const auto n = static_cast<std::size_t>(field_.channels);
  corner_values_.reserve(3 * n * triangles_.size());
  for (const auto& corners : triangles_)
    for (const std::uint32_t corner : corners)
      for (std::size_t k = 0; k < n; ++k) corner_values_.push_back(field_.of_points[corner * n + k]);
}

/// Rays and what becomes of them, on one thread: those of a square of the picture, or those that look around.
class ViewScene::Ways {
 public:
  Ways(const ViewScene& scene, const ViewOptions& options, bool looks_around = false)
      : scene_(scene), options_(options), looks_around_(looks_around), channels_(scene.field_.channels) {
    if (options.fine && options.gather > 0) inner_ = std::make_unique<Ways>(*options.around, kLooksAround, true);
  }

  /// keys   of the pixels' random numbers, one each
  /// count  rays a pixel
  void clear(std::span<const std::uint64_t> keys, std::size_t count) {
    count_ = count;
    keys_.assign(keys.begin(), keys.end());
    sum_.assign(keys.size() * static_cast<std::size_t>(channels_), 0), seen_.assign(keys.size(), 0);
  }

  /// Ray `sample` of a pixel, in the surfaces' frame.
  void start(std::size_t pixel, std::size_t sample, const Vec3& origin, const Vec3& direction, double near) {
    Way& way = next_way();
    way.pixel = static_cast<std::uint32_t>(pixel), way.number = static_cast<std::uint32_t>(sample);
    way.sample = static_cast<int>(sample);
    way.turns = 0, way.weight = Spectrum(1.0), way.share = 1, way.origin = origin, way.direction = direction;
    way.near = near, way.is_gloss = false;
    send_when(kLanes);
  }

  void finish() {
    send_when(1);
    // Rays that go on through panes, and those turned back, go the same way as their neighbours of the same kind.
    while (!through_.empty() || !back_.empty())
      for (std::vector<Way>* open : {&through_, &back_}) {
        const std::vector<Way> now = std::exchange(*open, {});
        for (const Way& way : now) next_way() = way, send_when(kLanes);
        send_when(1);
      }
  }

  /// Sums over the rays of a pixel.
  double sum(std::size_t pixel, int channel) const {
    return sum_[pixel * static_cast<std::size_t>(channels_) + static_cast<std::size_t>(channel)];
  }
  double seen(std::size_t pixel) const { return seen_[pixel]; }

 private:
  static constexpr std::size_t kLanes = 16;
  static constexpr ViewOptions kLooksAround{};
  struct Way {
    std::uint32_t pixel = 0, number = 0;  ///< of the tile; of the ray in it
    int sample = 0, turns = 0;            ///< sample: the number, or kStandsForSome
    Spectrum weight{1.0};
    double share = 1;        ///< of the rays that stand for one
    Vec3 origin, direction;  ///< of the surfaces' frame
    double near = 0;
    bool is_gloss = false;  ///< what comes along it adds to a surface that is seen already
  };

  Way& next_way() { return ways_[waiting_++]; }

  void send_when(std::size_t least) {
    if (waiting_ < least) return;
    SightPacket packet;
    packet.is_scattered = looks_around_;
    for (std::size_t k = 0; k < waiting_; ++k) packet.add(ways_[k].origin, ways_[k].direction, ways_[k].near);
    Sights sights;
    scene_.surfaces_.look(packet, sights);
    for (std::size_t k = 0; k < waiting_; ++k) {
      if (sights.triangle[k] != Sights::kNothing)
        take_surface(ways_[k], sights.triangle[k], sights.u[k], sights.v[k], double{sights.distance[k]});
      else if (sights.pane[k] != Sights::kNothing)
        turn(ways_[k], scene_.panes_[sights.pane[k]], double{sights.distance[k]});
      else
        take_sky(ways_[k]);
    }
    waiting_ = 0;
  }

  void add(const Way& way, int channel, double value) {
    const double most = way.sample == kStandsForSome ? kOneOf * options_.most : options_.most;
    sum_[way.pixel * static_cast<std::size_t>(channels_) + static_cast<std::size_t>(channel)] +=
        way.share * std::min(way.weight[channel] * value, most);
  }

  void take_surface(const Way& way, std::uint32_t triangle, float u, float v, double t) {
    const auto n = static_cast<std::size_t>(channels_);
    const float* corner = &scene_.corner_values_[triangle * 3 * n];
    Spectrum besides(0.0);
    if (options_.fine) besides = fine_light(way, triangle, u, v);
    for (std::size_t k = 0; k < n; ++k) {
      const double of_field{(1 - u - v) * corner[k] + u * corner[n + k] + v * corner[2 * n + k]};
      add(way, static_cast<int>(k), of_field + besides[static_cast<int>(k)]);
    }
    see(way, luminous_mean(way.weight));
    if (!scene_.lobes_.empty()) shine(way, triangle, t);
  }

  Draw draw_of(const Way& way) const {
    return {stream_key(keys_[way.pixel], static_cast<std::uint64_t>(way.turns)), way.number};
  }

  /// What the field leaves out.
  Spectrum fine_light(const Way& way, std::uint32_t triangle, double u, double v) {
    const auto& [a, b, c] = scene_.triangles_[triangle];
    const auto& x = scene_.result_.points;
    SeenPlace at;
    at.p = x[a] * (1 - u - v) + x[b] * u + x[c] * v;
    at.facet = normalized(cross(x[b] - x[a], x[c] - x[a]));
    at.to_eye = -normalized(way.direction);
    const auto& n = scene_.normal_;
    at.n = normalized(n[a] * (1 - u - v) + n[b] * u + n[c] * v);
    if (!(dot(at.n, at.to_eye) > 0)) at.n = at.facet;
    if (scene_.field_.is_radiance) {
      const std::uint32_t material = scene_.material_[triangle];
      if (!scene_.lobes_.empty())
        if (const int lobe = scene_.lobe_of_material_[material]; lobe >= 0)
          at.lobe = &scene_.lobes_[static_cast<std::size_t>(lobe)];
      if (scene_.is_black_[triangle] && !at.lobe) return Spectrum(0.0);
      at.diffuse = scene_.is_black_[triangle] ? Spectrum(0.0)
                                              : scene_.result_.materials[material].reflectance / std::numbers::pi;
    }
    const Draw draw = draw_of(way);
    Spectrum sent = options_.fine->sent_on(at, draw) + caustics(way, triangle, at);
    if (inner_ && !at.diffuse.is_black()) sent += at.diffuse * gathered(at, draw, rays_for(way));
    return scene_.field_.is_radiance ? sent : Spectrum(photometric(sent));
  }

  /// They are dear, and smooth within a pixel: one ray of four looks for all that meet one triangle straight.
  Spectrum caustics(const Way& way, std::uint32_t triangle, const SeenPlace& at) {
    if (way.turns > 0) return options_.fine->caustics(at);
    if (last_.uses == kOneOf || last_.pixel != way.pixel || last_.triangle != triangle)
      last_ = {way.pixel, triangle, 0, options_.fine->caustics(at)};
    ++last_.uses;
    return last_.caustics;
  }

  /// Of a gather at a place that is seen along this way: fewer where little of it is seen. A multiple of kOneOf.
  std::uint32_t rays_for(const Way& way) const {
    const double wanted = options_.gather * std::min(1.0, way.share * luminous_mean(way.weight));
    return static_cast<std::uint32_t>(std::max(1.0, std::ceil(wanted / kOneOf))) * kOneOf;
  }

  /// Irradiance by what `count` rays meet that look around [W/m2].
  Spectrum gathered(const SeenPlace& at, const Draw& draw, std::uint32_t count) {
    const SeenSurfaces& surfaces = options_.around->surfaces_;
    const std::uint64_t key = stream_key(draw.key, kGatherSeen);
    const Frame frame(at.n);
    const Vec3 origin = at.p - surfaces.centre();
    inner_->clear({&key, 1}, count);
    for (std::uint32_t k = 0; k < count; ++k) {
      const auto u = sobol4(draw.number * count + k, key);
      Vec3 d = cosine_direction(frame, u[0], u[1]);
      if (const double height = dot(d, at.facet); height < 0) d -= at.facet * (2 * height);
      inner_->start(0, k, origin, d, surfaces.lift());
    }
    inner_->finish();
    Spectrum L(0.0);
    for (int k = 0; k < kMaxChannels; ++k) L[k] = inner_->sum(0, std::min(k, inner_->channels_ - 1));
    return L * (std::numbers::pi / count);
  }

  void see(const Way& way, double weight) {
    if (!way.is_gloss) seen_[way.pixel] += weight;
  }

  /// A glossy surface shows besides what lies along one direction of its lobe.
  void shine(const Way& way, std::uint32_t triangle, double t) {
    const int number = scene_.lobe_of_material_[scene_.material_[triangle]];
    if (number < 0 || way.turns >= kMostTurns) return;
    const auto& [a, b, c] = scene_.triangles_[triangle];
    const auto& x = scene_.result_.points;
    const Vec3 n = normalized(cross(x[b] - x[a], x[c] - x[a])), d = normalized(way.direction);
    const Vec3 place = way.origin + way.direction * t;
    const auto follow = [&](double u, double v, std::uint32_t rays, std::uint32_t k) {
      const Lobe::Sample s = scene_.lobes_[static_cast<std::size_t>(number)].sample(n, -d, u, v);
      if (!(s.density > 0)) return;
      Way next = way;
      next.weight *= s.weight;
      const double weight = luminous_mean(next.weight);
      if (!(weight >= kLeastWeight)) return;
      if (looks_around_ && !is_one_of_some(next, weight)) return;
      next.share /= rays, next.number = way.number * rays + k;
      next.is_gloss = true, ++next.turns;
      next.origin = place, next.direction = s.direction, next.near = scene_.surfaces_.lift();
      back_.push_back(next);
    };
    if (!options_.fine) {
      RandomStream random(key_of_sight(place, d, way.sample), 0);
      const double u = random.uniform(), v = random.uniform();
      return follow(u, v, 1, 0);
    }
    const std::uint32_t rays = way.is_gloss ? 1 : kGlossRays;
    const std::uint64_t key = stream_key(draw_of(way).key, kGlossSeen);
    for (std::uint32_t k = 0; k < rays; ++k) {
      const auto numbers = sobol4(way.number * rays + k, key);
      follow(numbers[0], numbers[1], rays, k);
    }
  }

  /// Whether a way of that weight is followed: of dim ones one, which stands for all.
  bool is_one_of_some(Way& way, double weight) const {
    if (weight >= kDim || way.sample < 0 || count_ % kOneOf != 0) return true;
    if (way.sample % kOneOf != 0) return false;
    way.weight *= kOneOf, way.sample = kStandsForSome;
    return true;
  }

  void take_sky(const Way& way) {
    if (!scene_.field_.is_radiance || !options_.sees_sky || scene_.result_.around.sky.empty()) return;
    const Spectrum L = scene_.result_.around.sky(normalized(way.direction));
    for (int k = 0; k < channels_; ++k) add(way, k, L[k]);
    see(way, luminous_mean(way.weight));
  }

  void turn(const Way& way, const Pane& pane, double t) {
    const Vec3 unit = normalized(way.direction);
    const double cosine = dot(unit, pane.normal), lift = scene_.surfaces_.lift();
    const Vec3 place = way.origin + way.direction * t;
    const Vec3 back = unit - pane.normal * (2 * cosine);
    Spectrum on(0.0), turned = pane.mirror;
    if (pane.table >= 0) {
      const GlassTable& glass = scene_.glass_[static_cast<std::size_t>(pane.table)];
      on = glass.transmittance(cosine), turned = glass.reflectance(cosine);
    }
    // What a pane keeps, and what is not followed, is seen as dark.
    double followed = 0;
    const auto follow = [&](const Spectrum& share, const Vec3& direction, std::vector<Way>& open) {
      Way next = way;
      next.weight *= share;
      const double weight = luminous_mean(next.weight);
      if (!(weight >= kLeastWeight) || ++next.turns > kMostTurns) return;
      followed += weight;
      if (!is_one_of_some(next, weight)) return;
      next.origin = place, next.direction = direction, next.near = lift;
      open.push_back(next);
    };
    follow(on, unit, through_);
    follow(turned, back, back_);
    see(way, luminous_mean(way.weight) - followed);
  }

  const ViewScene& scene_;
  const ViewOptions& options_;
  bool looks_around_;
  std::size_t count_ = 0;
  int channels_;
  std::vector<std::uint64_t> keys_;
  std::vector<double> sum_, seen_;
  std::array<Way, kLanes> ways_;
  std::size_t waiting_ = 0;
  std::vector<Way> through_, back_;
  struct {
    std::uint32_t pixel = 0, triangle = 0;
    int uses = kOneOf;
    Spectrum caustics;
  } last_;                       ///< of those that were looked for
  std::unique_ptr<Ways> inner_;  ///< of a gather: rays from one place after the other
};

ViewImage ViewScene::trace(const Camera& camera, const ViewOptions& options, const Monitor& monitor) const {
  ViewImage image{.width = camera.width, .height = camera.height, .channels = field_.channels, .value = {}, .seen = {}};
  image.value.resize(image.pixels() * static_cast<std::size_t>(field_.channels)), image.seen.resize(image.pixels());
  Camera local = camera;
  local.eye -= surfaces_.centre();
  const auto pattern = sample_pattern(static_cast<std::size_t>(options.samples));
  const double share = 1.0 / static_cast<double>(pattern.size());

  /// A square of the picture.
  const auto trace_tile = [&](int x0, int y0) {
    const int x1 = std::min(x0 + kTileSide, image.width), y1 = std::min(y0 + kTileSide, image.height);
    std::vector<std::size_t> pixels;
    std::vector<std::uint64_t> keys;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        pixels.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                         static_cast<std::size_t>(x));
        keys.push_back(stream_key(kLightsSeen, pixels.back()));
      }
    Ways ways(*this, options);
    ways.clear(keys, pattern.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const auto width = static_cast<std::size_t>(image.width);
      const auto x = static_cast<double>(pixels[i] % width), y = static_cast<double>(pixels[i] / width);
      for (std::size_t k = 0; k < pattern.size(); ++k)
        if (const auto ray = ray_through(local, x + pattern[k][0], y + pattern[k][1]))
          ways.start(i, k, ray->origin, ray->direction, 0);
    }
    ways.finish();
    const auto n = static_cast<std::size_t>(image.channels);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      for (std::size_t k = 0; k < n; ++k)
        image.value[pixels[i] * n + k] = static_cast<float>(ways.sum(i, static_cast<int>(k)) * share);
      image.seen[pixels[i]] = static_cast<float>(ways.seen(i) * share);
    }
  };

  const int across = (image.width + kTileSide - 1) / kTileSide, down = (image.height + kTileSide - 1) / kTileSide;
  const auto tiles = static_cast<std::size_t>(across) * static_cast<std::size_t>(down);
  const Blocks blocks = parallel_blocks(
      tiles, std::max<std::size_t>(tiles / 16, 64), 1, "tracing", monitor, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          trace_tile(static_cast<int>(i) % across * kTileSide, static_cast<int>(i) / across * kTileSide);
        return 0ull;
      });
  return blocks.done == tiles ? image : ViewImage{};
}

double ViewScene::backs_around(const Vec3& eye) const {
  constexpr int kRows = 16;
  int backs = 0;
  for (int i = 0; i < kRows; ++i)
    for (int k = 0; k < 2 * kRows; ++k) {
      const double z = (i + 0.5) / kRows * 2 - 1, r = std::sqrt(1 - z * z);
      const double azimuth = (k + 0.5) / kRows * std::numbers::pi;
      backs += surfaces_.meets_back(eye, {r * std::cos(azimuth), r * std::sin(azimuth), z}) ? 1 : 0;
    }
  return backs / (2.0 * kRows * kRows);
}

}  // namespace clerestory
