#include "solver/view/trace_view.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/view/sample_pattern.h"

namespace clerestory {
namespace {

constexpr int kTileSide = 16;          // [pixel]
constexpr double kLeastWeight = 0.01;  // a way by which less would come is not followed
constexpr int kMostTurns = 16;
// Dim reflections are seen by one ray of four, which stands for all.
constexpr double kDim = 0.2;
constexpr int kOneOf = 4, kStandsForSome = -1;

/// Panes that the field is seen in: mirrors, and glass where light is shown.
std::vector<std::uint32_t> panes_that_show(const WrittenResult& result, bool is_radiance) {
  std::vector<std::uint32_t> shown;
  for (std::size_t i = 0; i < result.around.panes.size(); ++i)
    if (is_radiance || result.materials[result.around.panes[i].material].turns_rays())
      shown.push_back(static_cast<std::uint32_t>(i));
  return shown;
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

ViewScene::ViewScene(const WrittenResult& result, ShownField field, std::vector<std::uint32_t> triangles)
    : result_(result),
      field_(std::move(field)),
      triangles_(corners_of_triangles(result, triangles)),
      shown_panes_(panes_that_show(result, field_.is_radiance)),
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
    for (const std::uint32_t i : triangles) material_.push_back(result.material[i]);
  }
  const auto n = static_cast<std::size_t>(field_.channels);
  corner_values_.reserve(3 * n * triangles_.size());
  for (const auto& corners : triangles_)
    for (const std::uint32_t corner : corners)
      for (std::size_t k = 0; k < n; ++k) corner_values_.push_back(field_.of_points[corner * n + k]);
}

/// A square of the picture, on one thread.
class ViewScene::Tile {
 public:
  Tile(const ViewScene& scene, const Camera& local, const ViewOptions& options,
       const std::vector<std::array<double, 2>>& pattern, ViewImage& image)
      : scene_(scene),
        camera_(local),
        options_(options),
        pattern_(pattern),
        image_(image),
        channels_(scene.field_.channels) {}

  void trace(int x0, int y0, int x1, int y1) {
    width_ = x1 - x0;
    const auto pixels = static_cast<std::size_t>(width_ * (y1 - y0));
    sum_.assign(pixels * static_cast<std::size_t>(channels_), 0), seen_.assign(pixels, 0);
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x)
        for (std::size_t k = 0; k < pattern_.size(); ++k) {
          const auto ray = ray_through(camera_, x + pattern_[k][0], y + pattern_[k][1]);
          if (!ray) continue;
          Way& way = next_way();
          way.pixel = static_cast<std::uint32_t>((y - y0) * width_ + x - x0), way.sample = static_cast<int>(k);
          way.turns = 0, way.weight = Spectrum(1.0), way.origin = ray->origin, way.direction = ray->direction;
          way.near = 0, way.is_gloss = false;
          send_when(kLanes);
        }
    send_when(1);
    // Rays that go on through panes, and those turned back, go the same way as their neighbours of the same kind.
    while (!through_.empty() || !back_.empty())
      for (std::vector<Way>* open : {&through_, &back_}) {
        const std::vector<Way> now = std::exchange(*open, {});
        for (const Way& way : now) next_way() = way, send_when(kLanes);
        send_when(1);
      }
    write(x0, y0, y1);
  }

 private:
  static constexpr std::size_t kLanes = 16;
  struct Way {
    std::uint32_t pixel = 0;  ///< of the tile
    int sample = 0, turns = 0;
    Spectrum weight{1.0};
    Vec3 origin, direction;  ///< of the surfaces' frame
    double near = 0;
    bool is_gloss = false;  ///< what comes along it adds to a surface that is seen already
  };

  Way& next_way() { return ways_[waiting_++]; }

  void send_when(std::size_t least) {
    if (waiting_ < least) return;
    SightPacket packet;
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
        std::min(way.weight[channel] * value, most);
  }

  void take_surface(const Way& way, std::uint32_t triangle, float u, float v, double t) {
    const auto n = static_cast<std::size_t>(channels_);
    const float* corner = &scene_.corner_values_[triangle * 3 * n];
    for (std::size_t k = 0; k < n; ++k)
      add(way, static_cast<int>(k), double{(1 - u - v) * corner[k] + u * corner[n + k] + v * corner[2 * n + k]});
    see(way, luminous_mean(way.weight));
    if (!scene_.lobes_.empty()) shine(way, triangle, t);
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
    RandomStream random(key_of_sight(place, d, way.sample), 0);
    const double u = random.uniform(), v = random.uniform();
    const Lobe::Sample s = scene_.lobes_[static_cast<std::size_t>(number)].sample(n, -d, u, v);
    if (!(s.density > 0)) return;
    Way next = way;
    next.weight *= s.weight;
    if (!(luminous_mean(next.weight) >= kLeastWeight)) return;
    next.is_gloss = true, ++next.turns;
    next.origin = place, next.direction = s.direction, next.near = scene_.surfaces_.lift();
    back_.push_back(next);
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
      if (weight < kDim && way.sample >= 0 && pattern_.size() % kOneOf == 0) {
        if (way.sample % kOneOf != 0) return;
        next.weight *= kOneOf, next.sample = kStandsForSome;
      }
      next.origin = place, next.direction = direction, next.near = lift;
      open.push_back(next);
    };
    follow(on, unit, through_);
    follow(turned, back, back_);
    see(way, luminous_mean(way.weight) - followed);
  }

  void write(int x0, int y0, int y1) {
    const double share = 1.0 / static_cast<double>(pattern_.size());
    const auto n = static_cast<std::size_t>(channels_);
    for (int y = y0; y < y1; ++y)
      for (int x = 0; x < width_; ++x) {
        const auto from = static_cast<std::size_t>((y - y0) * width_ + x);
        const std::size_t to =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) + static_cast<std::size_t>(x0 + x);
        for (std::size_t k = 0; k < n; ++k) image_.value[to * n + k] = static_cast<float>(sum_[from * n + k] * share);
        image_.seen[to] = static_cast<float>(seen_[from] * share);
      }
  }

  const ViewScene& scene_;
  const Camera& camera_;
  const ViewOptions& options_;
  const std::vector<std::array<double, 2>>& pattern_;
  ViewImage& image_;
  int channels_, width_ = 0;
  std::vector<double> sum_, seen_;
  std::array<Way, kLanes> ways_;
  std::size_t waiting_ = 0;
  std::vector<Way> through_, back_;
};

ViewImage ViewScene::trace(const Camera& camera, const ViewOptions& options, const Monitor& monitor) const {
  ViewImage image{.width = camera.width, .height = camera.height, .channels = field_.channels, .value = {}, .seen = {}};
  image.value.resize(image.pixels() * static_cast<std::size_t>(field_.channels)), image.seen.resize(image.pixels());
  Camera local = camera;
  local.eye -= surfaces_.centre();
  const auto pattern = sample_pattern(static_cast<std::size_t>(options.samples));
  const int across = (image.width + kTileSide - 1) / kTileSide, down = (image.height + kTileSide - 1) / kTileSide;
  const auto tiles = static_cast<std::size_t>(across) * static_cast<std::size_t>(down);
  const Blocks blocks = parallel_blocks(
      tiles, std::max<std::size_t>(tiles / 16, 64), 1, "tracing", monitor, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const int x = static_cast<int>(i) % across * kTileSide, y = static_cast<int>(i) / across * kTileSide;
          Tile(*this, local, options, pattern, image)
              .trace(x, y, std::min(x + kTileSide, image.width), std::min(y + kTileSide, image.height));
        }
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
