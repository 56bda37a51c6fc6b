#include "solver/particles/emission.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "solver/lights/luminaire.h"
#include "solver/lights/near_planes.h"
#include "solver/lights/sun.h"
#include "solver/model/box.h"
#include "solver/model/units.h"
#include "solver/particles/luminaire_directions.h"
#include "solver/particles/sky_directions.h"
#include "solver/sampling/unit_square.h"

namespace clerestory {
namespace {

/// Faces of the box around the scene, seen from outside: all light that enters it passes exactly one.
std::vector<LightArea> faces_of(const Box& box) {
  std::vector<LightArea> faces;
  const Vec3 size = box.upper - box.lower, axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int k = 0; k < 3; ++k)
    for (const bool from_above : {false, true}) {
      const Vec3 a = axes[(k + 1) % 3] * size[(k + 1) % 3], b = axes[(k + 2) % 3] * size[(k + 2) % 3];
      const Vec3 corner = box.lower + (from_above ? axes[k] * size[k] : Vec3{});
      LightArea face;
      face.corners = from_above ? std::vector<Vec3>{corner, corner + b, corner + a + b, corner + a}
                                : std::vector<Vec3>{corner, corner + a, corner + a + b, corner + b};
      const auto& c = face.corners;
      face.triangles = {{c[0], c[1], c[2]}, {c[0], c[2], c[3]}};
      face.centre = corner + (a + b) / 2;
      face.normal = from_above ? -axes[k] : axes[k];
      face.radius = length(a + b) / 2;
      face.area = length(a) * length(b);
      faces.push_back(std::move(face));
    }
  return faces;
}

struct LineInBox {
  double enters, leaves;
  int face;  ///< number among faces_of(), that it enters by
};
LineInBox line_in_box(const Box& box, const Vec3& p, const Vec3& d) {
  LineInBox line{-Box::kHuge, Box::kHuge, 0};
  for (int k = 0; k < 3; ++k) {
    if (d[k] == 0) {
      if (p[k] < box.lower[k] || p[k] > box.upper[k]) return {1, 0, 0};
      continue;
    }
    const double enters = ((d[k] > 0 ? box.lower[k] : box.upper[k]) - p[k]) / d[k];
    if (enters > line.enters) line.enters = enters, line.face = 2 * k + (d[k] < 0);
    line.leaves = std::min(line.leaves, ((d[k] > 0 ? box.upper[k] : box.lower[k]) - p[k]) / d[k]);
  }
  return line;
}

}  // namespace

struct Emission::Impl {
  explicit Impl(const Illumination& light);

  enum class Kind : std::uint8_t { luminaire, sun, sky, patch };
  /// Entries of `choice`, one kind after another: luminaires, each sun by each gate, the sky by each gate, patches.
  std::size_t first_sun = 0, first_sky = 0, first_patch = 0;

  Kind kind_of(std::size_t entry) const {
    return entry < first_sun     ? Kind::luminaire
           : entry < first_sky   ? Kind::sun
           : entry < first_patch ? Kind::sky
                                 : Kind::patch;
  }

  /// Sum over the gates that the line through p along d passes of probability / (area cosine) times what of_gate tells.
  template <class OfGate>
  double over_gates(const Vec3& p, const Vec3& d, std::size_t first_entry, std::size_t surely,
                    const OfGate& of_gate) const {
    const auto part = [&](std::size_t k) {
      const double cosine = dot(d, gates[k].normal), probability = choice.probability(first_entry + k);
      return cosine > 0 && probability > 0 ? probability / (gates[k].area * cosine) * of_gate(k) : 0.0;
    };
    const LineInBox line = line_in_box(box, p, d);
    double sum = 0;
    if (line.enters < line.leaves) sum += part(static_cast<std::size_t>(line.face));
    const Vec3 end = p + d * line.leaves;
    for (std::size_t k = kFaces; k < gates.size(); ++k)
      if (k == surely || (spheres[k].is_passed(end, -d) && way_out(gates[k], end, -d) >= 0)) sum += part(k);
    return sum;
  }

  Emitted from_luminaire(std::size_t entry, double probability, const std::array<double, 4>& u) const;
  Emitted from_sun(std::size_t entry, const std::array<double, 4>& u) const;
  Emitted from_sky(std::size_t entry, const std::array<double, 4>& u) const;
  Emitted from_patch(std::size_t entry, double probability, const std::array<double, 4>& u) const;
  Ray into_box(const Vec3& through, const Vec3& d) const {
    return {through + d * line_in_box(box, through, d).enters, d};
  }

  static constexpr std::size_t kFaces = 6;
  static constexpr std::size_t kNoGate = ~std::size_t{0};

  const Illumination& light;
  Box box;                       ///< around the scene, with room for rays to start
  std::vector<LightArea> gates;  ///< that sun and sky come in by: faces of the box, then openings
  std::vector<OpeningSphere> spheres;
  std::vector<std::uint32_t> luminaires;  ///< by entry: not all are the scene's own
  std::vector<std::uint32_t> suns;
  std::vector<PatchId> patches;
  std::vector<std::uint32_t> entry_of_patch;  ///< N; empty where none glows
  std::map<const PhotometricWeb*, WebDirections> webs;
  std::optional<SkyDirections> sky;
  std::vector<SkyDirections::Plane> sky_by_gate;
  CumulativeTable choice;
  double flux = 0;
};

Emission::Impl::Impl(const Illumination& of) : light(of) {
  const PatchSet& set = light.problem.patches;
  const Lights& lights = light.problem.lights;
  std::vector<double> weight;  // by entry [W]

  for (std::uint32_t k = 0; k < lights.luminaires.size(); ++k) {
    const PlacedLuminaire& luminaire = lights.luminaires[k];
    const double sends = luminous_mean(power(luminaire));
    if (luminaire.is_image() || !(sends > 0)) continue;
    if (const auto* web = std::get_if<WebLuminaire>(&luminaire.kind)) webs.try_emplace(web->web.get(), *web->web);
    luminaires.push_back(k);
    weight.push_back(sends);
    flux += sends;
  }
  first_sun = weight.size();

  box = Box::around(set.vertices).grown(1e-3 * light.problem.rays.diameter());
  gates = faces_of(box);
  const auto openings = lights.sky_openings();
  gates.insert(gates.end(), openings.begin(), openings.end());
  for (const LightArea& gate : gates) spheres.emplace_back(gate);
  for (std::uint32_t k = 0; k < lights.suns.size(); ++k) {
    const PlacedSun& sun = lights.suns[k];
    if (sun.is_image() || sun.normal_irradiance.is_black()) continue;
    suns.push_back(static_cast<std::uint32_t>(lights.luminaires.size()) + k);
    for (const LightArea& gate : gates)
      weight.push_back(luminous_mean(sun.normal_irradiance) * gate.area *
                       std::max(0.0, -dot(sun.direction, gate.normal)));
  }
  first_sky = weight.size();
  if (!light.sky.dark()) {
    sky.emplace(light.sky);
    for (std::size_t k = 0; k < gates.size(); ++k) {
      sky_by_gate.emplace_back(*sky, gates[k].normal);
      weight.push_back(gates[k].area * sky_by_gate.back().irradiance());
      if (k < kFaces) flux += gates[k].area * sky->irradiance(gates[k].normal);
    }
  }
  // Where light comes in by openings, most particles are sent through them: rooms are what is asked for.
  constexpr double kOverBox = 1.0 / 3;  // for one over openings
  double over_box = 0, over_openings = 0;
  for (std::size_t entry = first_sun; entry < weight.size(); ++entry) {
    const bool is_face = (entry - first_sun) % gates.size() < kFaces;
    (is_face ? over_box : over_openings) += weight[entry];
    if (is_face && entry < first_sky) flux += weight[entry];
  }
  if (over_openings > 0 && kOverBox * over_openings < over_box)
    for (std::size_t entry = first_sun; entry < weight.size(); ++entry)
      if ((entry - first_sun) % gates.size() < kFaces) weight[entry] *= kOverBox * over_openings / over_box;

  first_patch = weight.size();
  for (std::size_t i = 0; i < set.patch_count(); ++i) {
    const double sends = luminous_mean(set.M[i]) * set.area[i];
    if (!(sends > 0)) continue;
    if (entry_of_patch.empty()) entry_of_patch.assign(set.patch_count(), Emitted::kNone);
    entry_of_patch[i] = static_cast<std::uint32_t>(weight.size());
    patches.emplace_back(i);
    weight.push_back(sends);
    flux += sends;
  }
  choice = CumulativeTable(weight);
}

Emitted Emission::Impl::from_luminaire(std::size_t entry, double probability, const std::array<double, 4>& u) const {
  const std::uint32_t number = luminaires[entry];
  const PlacedLuminaire& luminaire = light.problem.lights.luminaires[number];
  const Vec3 d = std::visit(
      [&](const auto& kind) {
        if constexpr (requires { kind.web; })
          return sample_direction(kind, webs.at(kind.web.get()), u[2], u[3]);
        else
          return sample_direction(kind, u[2], u[3]);
      },
      luminaire.kind);
  const Spectrum sends = power(luminaire);
  Emitted e;
  e.ray = {ray_start(luminaire, light_point(luminaire, luminaire.position, u[0], u[1]), d), d};
  e.flux = sends / probability;
  e.light = number;
  e.normal = d;
  e.density_place = probability;
  e.density_direction = luminous_mean(intensity(luminaire, d)) / luminous_mean(sends);
  return e;
}

Emitted Emission::Impl::from_sun(std::size_t entry, const std::array<double, 4>& u) const {
  const std::size_t k = (entry - first_sun) / gates.size(), gate = (entry - first_sun) % gates.size();
  const PlacedSun& sun = light.problem.lights.suns[suns[k] - light.problem.lights.luminaires.size()];
  const Vec3 d = -direction_to_sun(sun, u[2], u[3]), through = point_of(gates[gate], u[0], u[1]);
  Emitted e;
  e.ray = into_box(through, d);
  e.light = suns[k];
  e.normal = d;
  e.density_place = over_gates(through, d, first_sun + k * gates.size(), gate, [](std::size_t) { return 1.0; });
  e.density_direction = density_in_disc(sun, -d);
  if (dot(d, gates[gate].normal) > 0 && e.density_place > 0) e.flux = sun.normal_irradiance / e.density_place;
  return e;
}

Emitted Emission::Impl::from_sky(std::size_t entry, const std::array<double, 4>& u) const {
  const std::size_t gate = entry - first_sky;
  const Vec3 d = sky_by_gate[gate].sample(*sky, u[2], u[3]), through = point_of(gates[gate], u[0], u[1]);
  Emitted e;
  e.ray = into_box(through, d);
  e.normal = d;
  e.density_direction = sky_by_gate[gate].density(*sky, d);
  if (!(dot(d, gates[gate].normal) > 0)) return e;
  const double density =
      over_gates(through, d, first_sky, gate, [&](std::size_t g) { return sky_by_gate[g].density(*sky, d); });
  if (!(density > 0)) return e;
  e.density_place = density / e.density_direction;
  e.flux = light.sky(-d) / density;
  return e;
}

Emitted Emission::Impl::from_patch(std::size_t entry, double probability, const std::array<double, 4>& u) const {
  const PatchSet& set = light.problem.patches;
  const PatchId p = patches[entry - first_patch];
  const Vec3& n = set.normal[p];
  Emitted e;
  e.ray.origin = light.problem.rays.off_surface(point_on_triangle(set.corner_positions(p), u[0], u[1]), n);
  e.ray.direction = cosine_direction(Frame(n), u[2], u[3]);
  e.flux = set.M[p] * (set.area[p] / probability);
  e.patch = p;
  e.normal = n;
  e.density_place = probability / set.area[p];
  e.density_direction = dot(n, e.ray.direction) / std::numbers::pi;
  return e;
}

Emission::Emission(const Illumination& light) : impl_(std::make_unique<const Impl>(light)) {}
Emission::~Emission() = default;
Emission::Emission(Emission&&) noexcept = default;
Emission& Emission::operator=(Emission&&) noexcept = default;

bool Emission::empty() const { return impl_->choice.empty(); }
double Emission::flux() const { return impl_->flux; }

Emitted Emission::sample(double pick, const std::array<double, 4>& u) const {
  const auto [entry, probability, rest] = impl_->choice.choose(pick);
  switch (impl_->kind_of(entry)) {
    case Impl::Kind::luminaire:
      return impl_->from_luminaire(entry, probability, u);
    case Impl::Kind::sun:
      return impl_->from_sun(entry, u);
    case Impl::Kind::sky:
      return impl_->from_sky(entry, u);
    case Impl::Kind::patch:
      break;
  }
  return impl_->from_patch(entry, probability, u);
}

double Emission::density_of_patch(PatchId p) const {
  if (impl_->entry_of_patch.empty() || impl_->entry_of_patch[p] == Emitted::kNone) return 0;
  return impl_->choice.probability(impl_->entry_of_patch[p]) / impl_->light.problem.patches.area[p];
}

double Emission::probability_of_luminaire(std::uint32_t number) const {
  const auto at = std::ranges::lower_bound(impl_->luminaires, number);
  if (at == impl_->luminaires.end() || *at != number) return 0;
  return impl_->choice.probability(static_cast<std::size_t>(at - impl_->luminaires.begin()));
}

double Emission::density_of_direction(std::uint32_t number, const Vec3& d) const {
  const Luminaire& luminaire = impl_->light.problem.lights.luminaires[number];
  const double sends = luminous_mean(power(luminaire));
  return sends > 0 ? luminous_mean(intensity(luminaire, d)) / sends : 0;
}

double Emission::density_of_sky(const Vec3& p, const Vec3& d) const {
  if (!impl_->sky) return 0;
  return impl_->over_gates(p, d, impl_->first_sky, Impl::kNoGate,
                           [&](std::size_t gate) { return impl_->sky_by_gate[gate].density(*impl_->sky, d); });
}

double Emission::density_of_sun(std::uint32_t number, const Vec3& p, const Vec3& d) const {
  const auto at = std::ranges::lower_bound(impl_->suns, number);
  if (at == impl_->suns.end() || *at != number) return 0;
  const Lights& lights = impl_->light.problem.lights;
  const auto k = static_cast<std::size_t>(at - impl_->suns.begin());
  return density_in_disc(lights.suns[number - lights.luminaires.size()], -d) *
         impl_->over_gates(p, d, impl_->first_sun + k * impl_->gates.size(), Impl::kNoGate,
                           [](std::size_t) { return 1.0; });
}

}  // namespace clerestory
