#include "solver/illumination/gloss_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "solver/illumination/one_light.h"
#include "solver/lights/luminaire.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/sampling/unit_square.h"
#include "solver/visibility/echoes.h"

namespace clerestory {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kMostImages = 1 << 16;
/// Directions around an axis whose tangents t to it are spread as s2 / (s2 + t2)^2: like the slopes of GGX, and with
/// more far from the axis than any lobe of modified Phong has.
struct Cone {
  Vec3 axis;
  double s2;

  double density(const Vec3& d) const {
    const double c = dot(axis, d);
    if (!(c > 0)) return 0;
    const double c2 = c * c, both = s2 * c2 + std::max(0.0, 1 - c2);
    return s2 * c / (kPi * both * both);
  }
  Vec3 direction(double u, double v) const {
    const double t = std::sqrt(s2 * u / (1 - u)), c = 1 / std::sqrt(1 + t * t);
    return Frame(axis).to_world(t * c * std::cos(2 * kPi * v), t * c * std::sin(2 * kPi * v), c);
  }
};

}  // namespace

/// Of a glossy surface, as the receiver sees it.
struct GlossLight::Place {
  Vec3 x, n;  ///< lifted; normal on the receiver's side
  Vec3 to_receiver;
  const Lobe* lobe;
  std::uint32_t plane;
};

/// One receiver at its work.
class GlossLight::Look {
 public:
  Look(const GlossLight& all, const Vec3& p, const Vec3& n, LightRow* row)
      : all_(all), problem_(all.problem_), rays_(problem_.rays), p_(p), n_(n), row_(row) {}

  const GlossIrradiance& E() const { return E_; }

  void all_around(const Numbers& u, RandomStream& random) {
    const Ray ray{p_, cosine_direction(Frame(n_), u[0][0], u[0][1])};
    Echo echo;
    const Hit hit = rays_.first_hit(problem_.patches, ray, &echo);
    if (const auto place = place_of(ray, hit)) {
      const LightTree::Choice choice = all_.lights_.choose(place->x, place->n, u[0][2]);
      if (choice.probability > 0) {
        const Vec3 point = point_of(choice.light, u[1][0], u[1][1]);
        const double other = hit.reflected ? 0 : density_by_image(*place, choice.light, point, ray.direction);
        const double cosine = dot(n_, ray.direction), own = cosine / kPi * choice.probability;
        take(*place, choice.light, point, hit.transmittance * (cosine / (own + other)));
      }
    }
    if (echo.is_none()) return;
    follow_echo(rays_, problem_.patches, echo, random, [&](const Hit& behind) {
      const auto place = place_of(ray, behind);
      if (!place) return;
      const LightTree::Choice choice = all_.lights_.choose(place->x, place->n, random.uniform());
      const double s = random.uniform(), t = random.uniform();
      if (choice.probability > 0)
        take(*place, choice.light, point_of(choice.light, s, t), behind.transmittance * (kPi / choice.probability));
    });
  }

  void at_an_image(const Numbers& u) {
    const LightTree::Choice choice = all_.images_.choose(p_, n_, u[1][2]);
    if (!(choice.probability > 0)) return;
    const Image image = all_.image(choice.light);
    const Vec3 point = point_of(image.light, u[2][2], u[2][3]);
    const auto cone = cone_of(image, point);
    if (!cone) return;
    const Ray ray{p_, cone->direction(u[2][0], u[2][1])};
    const double cosine = dot(n_, ray.direction);
    if (!(cosine > 0)) return;
    const Hit hit = rays_.first_hit(problem_.patches, ray);
    if (hit.reflected) return;
    const auto place = place_of(ray, hit);
    if (!place || place->plane != image.plane) return;
    const double own = choice.probability * cone->density(ray.direction);
    const double other = cosine / kPi * all_.lights_.probability(image.light, place->x, place->n);
    if (own > 0) take(*place, image.light, point, hit.transmittance * (cosine / (own + other)));
  }

 private:
  std::optional<Place> place_of(const Ray& ray, const Hit& hit) const {
    const Vec3& d = hit.direction(ray);
    const Lobe* lobe = rays_.lobe(hit.triangle, d);
    if (!lobe) return {};
    const Vec3 front = rays_.normal(hit.triangle);
    const bool on_front = dot(front, d) < 0;
    if (all_.leaves_narrow_ && rays_.gloss().narrow_without_plane(hit.triangle, on_front ? kFront : kBack)) return {};
    const Vec3 n = on_front ? front : -front;
    const Vec3 x = rays_.off_surface(rays_.in_plane_of(hit.triangle, hit.position(ray)), n);
    return Place{x, n, -d, lobe, rays_.gloss().plane(hit.triangle)};
  }

  Vec3 point_of(std::uint32_t light, double u, double v) const { return point_of_light(problem_.lights, light, u, v); }

  /// Of at_an_image() that a ray goes along d, the light being that one and its light coming from `point`.
  double density_by_image(const Place& place, std::uint32_t light, const Vec3& point, const Vec3& d) const {
    const Image image{place.plane, light};
    const auto number = all_.number_of_image(image);
    if (!number) return 0;
    const auto cone = cone_of(image, point);
    return cone ? all_.images_.probability(*number, p_, n_) * cone->density(d) : 0;
  }

  /// About where the lobe is bright, seen from the receiver. From there it is narrower than at its place: turning the
  /// eye by an angle moves the place, and the light comes to it from elsewhere.
  std::optional<Cone> cone_of(const Image& image, const Vec3& point) const {
    const GlossySides::Plane& plane = rays_.gloss().planes()[image.plane];
    const double height = plane.place.height(p_);
    const double spread = 2 / std::max(1.0, plane.sharpness);
    if (is_sun(problem_.lights, image.light)) {
      if (!(dot(plane.place.normal, point) * height > 0)) return {};
      return Cone{plane.place.image_of_direction(point), spread};
    }
    const double height_of_light = plane.place.height(point);
    if (!(height_of_light * height > 0)) return {};
    const double beyond = height_of_light / (height_of_light + height);
    return Cone{normalized(plane.place.image_of(point) - p_), beyond * beyond * spread};
  }

  void take(const Place& place, std::uint32_t light, const Vec3& point, const Spectrum& weight) {
    const auto [to_light, irradiance] = light_from_point(problem_, light, point, place.x, place.n);
    if (irradiance.is_black()) return;
    const Spectrum found = place.lobe->evaluate(place.n, to_light, place.to_receiver) * irradiance * weight;
    if (found.is_black()) return;
    (is_sun(problem_.lights, light) ? E_.suns : E_.luminaires) += found;
    if (row_) row_->push_back(RowEntry::of_light(light, found));
  }

  const GlossLight& all_;
  const Problem& problem_;
  const RayScene& rays_;
  const Vec3 p_, n_;
  LightRow* row_;
  GlossIrradiance E_;
};

GlossLight::GlossLight(const Problem& problem)
    : problem_(problem), leaves_narrow_(std::ranges::any_of(problem.lights.caustics.sides, [](const CausticSide& side) {
        return side.mirror.is_black();
      })) {
  const Lights& lights = problem.lights;
  if (!problem.rays.has_gloss() || (lights.luminaires.empty() && lights.suns.empty())) return;
  lights_ = choice_of_lights(problem);

  std::vector<LightBounds> image_luminaires;
  std::vector<LightChoice::Sun> image_suns;
  const std::size_t per_plane = lights.luminaires.size() + lights.suns.size();
  const auto& planes = problem.rays.gloss().planes();
  planes_with_images_ = static_cast<std::uint32_t>(std::min(planes.size(), kMostImages / per_plane));
  for (std::uint32_t g = 0; g < planes_with_images_; ++g) {
    for (std::uint32_t k = 0; k < lights.luminaires.size(); ++k) {
      image_luminaires.push_back(bounds(image_of(lights.luminaires[k], planes[g].place)));
      image_luminaires.back().power *= lights.luminaires[k].share;
    }
    for (const PlacedSun& sun : lights.suns)
      image_suns.push_back(
          {planes[g].place.image_of_direction(sun.direction), sun.share * luminous_mean(sun.normal_irradiance)});
  }
  images_ = LightChoice(image_luminaires, image_suns, problem.rays.diameter());
}

GlossLight::Image GlossLight::image(std::uint32_t number) const {
  const auto luminaires = static_cast<std::uint32_t>(problem_.lights.luminaires.size()),
             suns = static_cast<std::uint32_t>(problem_.lights.suns.size());
  const std::uint32_t of_luminaires = planes_with_images_ * luminaires;
  if (number < of_luminaires) return {number / luminaires, number % luminaires};
  const std::uint32_t of_suns = number - of_luminaires;
  return {of_suns / suns, luminaires + of_suns % suns};
}

std::optional<std::uint32_t> GlossLight::number_of_image(const Image& image) const {
  if (image.plane >= planes_with_images_) return {};  // kNoPlane, too
  const auto luminaires = static_cast<std::uint32_t>(problem_.lights.luminaires.size()),
             suns = static_cast<std::uint32_t>(problem_.lights.suns.size());
  if (image.light < luminaires) return image.plane * luminaires + image.light;
  return planes_with_images_ * luminaires + image.plane * suns + image.light - luminaires;
}

GlossIrradiance GlossLight::by_one_pair(const Vec3& p, const Vec3& n, const Numbers& u, RandomStream& random,
                                        LightRow* row) const {
  if (empty()) return {};
  Look look(*this, p, n, row);
  look.all_around(u, random);
  if (!images_.empty()) look.at_an_image(u);
  return look.E();
}

GlossIrradiance GlossLight::irradiance(const Vec3& p, const Vec3& n, int count, std::uint64_t key,
                                       LightRow* row) const {
  if (empty()) return {};
  GlossIrradiance E;
  const std::size_t begin = row ? row->size() : 0;
  for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(count); ++k) {
    RandomStream random(key, k, 1);
    const GlossIrradiance found =
        by_one_pair(p, n,
                    {sobol4(k, stream_key(key, kGlossPairs, 0)), sobol4(k, stream_key(key, kGlossPairs, 1)),
                     sobol4(k, stream_key(key, kGlossPairs, 2))},
                    random, row);
    E.luminaires += found.luminaires, E.suns += found.suns;
  }
  if (row)
    for (std::size_t e = begin; e < row->size(); ++e) (*row)[e].scale(Spectrum(1.0 / count));
  return {E.luminaires / count, E.suns / count};
}

}  // namespace clerestory
