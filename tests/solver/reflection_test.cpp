// Light that glass and mirrors turn: closed forms, and a tracer that shares nothing with the solver.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "solver/illumination/image_beams.h"
#include "solver/illumination/light_sampler.h"
#include "solver/illumination/place_lights.h"
#include "solver/lights/sun.h"
#include "solver/methods/hierarchical.h"
#include "solver/model/error.h"
#include "solver/run/solve.h"
#include "solver/sampling/unit_square.h"
#include "solver/visibility/echoes.h"
#include "solver/visibility/glass_sheet.h"
#include "tests/support/luminaires.h"
#include "tests/support/photon_tracer.h"
#include "tests/support/room_with_blocks.h"
#include "tests/support/unjoined_lightmap.h"

namespace clerestory {
namespace {

using test::PatchBuilder;
using test::PhotonTracer;
using test::TracedRectangle;

constexpr double kPi = std::numbers::pi;

TEST(GlassSheet, ReflectsPassesAndAbsorbsAllThereIs) {
  for (const double T : {0.1, 0.5, 0.65, 0.88, 0.91}) {
    const GlassSheet sheet = fit_glass_sheet(T);
    const double absorption = test::TracedSheet::absorption(T);
    for (const double c : {1.0, 0.9, 0.7, 0.5, 0.3, 0.1, 0.02}) {
      const SheetShares shares = sheet_shares(sheet, c);
      const test::TracedSheet traced(c, absorption);
      EXPECT_NEAR(shares.transmittance, traced.transmitted, 1e-10);
      EXPECT_NEAR(shares.reflectance, traced.reflected, 1e-10);
      EXPECT_LT(shares.transmittance + shares.reflectance, 1);
    }
  }
  for (const double T : {kClearGlass, 0.95, 1.0})  // absorb nothing
    for (const double c : {1.0, 0.5, 0.1, 0.0}) {
      const SheetShares shares = sheet_shares(fit_glass_sheet(T), c);
      EXPECT_NEAR(shares.transmittance + shares.reflectance, 1, 1e-12);
    }
}

/// A scene made twice: as patches, and as rectangles for the tracer.
class Twice {
 public:
  /// cells  about this long [m]
  explicit Twice(double cells) : cells_(cells), builder_(0.5) {}

  /// returns  its number
  std::size_t diffuse(double rho, const Vec3& o, const Vec3& u, const Vec3& v) {
    builder_.material(rho).rectangle(o, u, v, cells_of(u), cells_of(v));
    traced_.push_back({o, u, v, TracedRectangle::diffuse, rho});
    return traced_.size() - 1;
  }
  void mirror(double rho, const Vec3& o, const Vec3& u, const Vec3& v) {
    builder_.mirror(rho).rectangle(o, u, v);
    traced_.push_back({o, u, v, TracedRectangle::mirror, rho});
  }
  void glass(double transmittance, const Vec3& o, const Vec3& u, const Vec3& v) {
    builder_.glass(transmittance).rectangle(o, u, v);
    traced_.push_back({o, u, v, TracedRectangle::glass, transmittance});
  }

  PhotonTracer tracer() const { return PhotonTracer(traced_); }
  PatchSet patches() { return builder_.build(); }
  struct Mean {
    double E, std_error;
  };
  /// Mean irradiance of a rectangle.
  Mean mean(const PatchSet& patches, const Solution& s, std::size_t rectangle) const {
    const TracedRectangle& r = traced_[rectangle];
    const Vec3 n = normalized(cross(r.u, r.v));
    double flux = 0, area = 0, variance = 0;
    for (std::size_t i = 0; i < patches.patch_count(); ++i) {
      const auto c = patches.corner_positions(PatchId{i});
      const Vec3 x = (c[0] + c[1] + c[2]) / 3 - r.corner;
      const double a = dot(x, r.u) / dot(r.u, r.u), b = dot(x, r.v) / dot(r.v, r.v);
      if (dot(patches.normal[i], n) < 0.99 || std::abs(dot(x, n)) > 1e-6 || a < 0 || a > 1 || b < 0 || b > 1) continue;
      flux += patches.area[i] * s.E[i][0], area += patches.area[i];
      if (s.std_error.size() > 0) variance += std::pow(patches.area[i] * s.std_error[i][0], 2);
    }
    EXPECT_NEAR(area, length(r.u) * length(r.v), 1e-6);
    return {flux / area, std::sqrt(variance) / area};
  }
  /// n x n sensors all over it.
  std::vector<SensorPoint> sensors(std::size_t rectangle, int n) const {
    const TracedRectangle& r = traced_[rectangle];
    std::vector<SensorPoint> points;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        points.push_back({r.corner + r.u * ((i + 0.5) / n) + r.v * ((j + 0.5) / n), normalized(cross(r.u, r.v))});
    return points;
  }

 private:
  std::size_t cells_of(const Vec3& side) const {
    return static_cast<std::size_t>(std::max(1.0, std::round(length(side) / cells_)));
  }
  double cells_;
  PatchBuilder builder_;
  std::vector<TracedRectangle> traced_;
};

struct Watched {
  std::string name;
  std::size_t rectangle;
};

/// These methods, the hierarchical one, and sensors against the tracer.
void compare(Twice& scene, const LightSpec& spec, const PhotonTracer& exact, const std::vector<Watched>& watched,
             const std::vector<Method>& methods) {
  constexpr double kTolerance = 0.02;
  const PatchSet patches = scene.patches();
  const RayScene rays(patches);
  const Lights lights = place_lights(spec, patches, rays);
  EXPECT_LT(lights.lost_in_mirrors, 0.01);
  const Problem problem{patches, rays, lights};
  const auto check = [&](const PatchSet& on, const Solution& s, const std::string& method) {
    for (const Watched& w : watched) {
      const Twice::Mean mean = scene.mean(on, s, w.rectangle);
      const double expected = exact.irradiance(w.rectangle);
      EXPECT_NEAR(mean.E, expected, std::max(kTolerance * expected, 4 * mean.std_error))
          << method << ", " << w.name << ": " << mean.E / expected << " +- " << mean.std_error / expected;
    }
    EXPECT_NEAR(s.energy.imbalance(), 0, 0.01) << method;
  };
  for (const Method method : methods)
    check(patches, solve_on_patches(problem, {.method = method}),
          std::string(kMethodNames[static_cast<std::size_t>(method)]));
  const VertexLightmap map = test::unjoined_lightmap(patches);
  ElementMesh mesh(patches, map);
  const HierarchicalSolution solved = hierarchical(problem, mesh, {.shortest_edge = 0.1});
  check(solved.elements, solved.solution, "hierarchical");
  for (const Watched& w : watched) {
    const auto points = scene.sensors(w.rectangle, 24);
    const PointIrradiance at = irradiance_at_sensors({solved.elements, rays, lights}, solved.solution, points, {});
    double mean = 0;
    for (std::size_t k = 0; k < points.size(); ++k) mean += at.E[k][0] / static_cast<double>(points.size());
    EXPECT_NEAR(mean / exact.irradiance(w.rectangle), 1, kTolerance) << "sensors, " << w.name;
  }
}

TEST(Reflection, AStreetBeforeASunlitGlassFacade) {
  Twice scene(1.0);
  const std::size_t pavement = scene.diffuse(0.2, {0, -6, 0}, {8, 0, 0}, {0, 12, 0});
  const std::size_t house = scene.diffuse(0.5, {8, -6, 0}, {0, 0, 6}, {0, 12, 0});
  scene.diffuse(0.1, {-2, -6, 0}, {0, 12, 0}, {0, 0, 8});  // dark offices behind the glass
  scene.glass(0.5, {0, -6, 0}, {0, 12, 0}, {0, 0, 8});
  const Vec3 to_sun = normalized({0.6, 0.15, 0.8});
  LightSpec spec;
  spec.suns = {{to_sun, Spectrum(500)}};
  spec.sky = Sky{.model = SkyModel::uniform, .horizontal_irradiance = Spectrum(50.0 * kPi), .ground_reflectance = 0};

  PhotonTracer exact = scene.tracer();
  const Vec3 centre{3, 0, 3};
  constexpr double kRadius = 10;  // of a sphere around all
  const auto from_sky = [&](const Vec3& direction, PhotonTracer::Random& random) -> PhotonTracer::Photon {
    const Vec3 a = normalized(cross(std::abs(direction.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, direction)),
               b = cross(direction, a);
    const double r = kRadius * std::sqrt(PhotonTracer::uniform(random)), phi = 2 * kPi * PhotonTracer::uniform(random);
    return {centre + a * (r * std::cos(phi)) + b * (r * std::sin(phi)) - direction * (2 * kRadius), direction};
  };
  exact.follow(2'000'000, 500 * kPi * kRadius * kRadius,
               [&](PhotonTracer::Random& random) { return from_sky(-to_sun, random); });
  exact.follow(3'000'000, 50 * 2 * kPi * kPi * kRadius * kRadius, [&](PhotonTracer::Random& random) {
    Vec3 d = PhotonTracer::anywhere(random);
    if (d.z > 0) d.z = -d.z;
    return from_sky(d, random);
  });
  compare(scene, spec, exact, {{"pavement", pavement}, {"house", house}},
          {Method::progressive, Method::path, Method::bidirectional, Method::particles, Method::gauss_seidel});
}

PhotonTracer::Photon from_lamp(const Vec3& lamp, PhotonTracer::Random& random) {
  return {lamp, PhotonTracer::anywhere(random)};
}

TEST(Reflection, ARoomAtNightBehindItsGlazing) {
  Twice scene(0.5);
  scene.diffuse(0.1, {0, 0, 0}, {5, 0, 0}, {0, 4, 0});
  scene.diffuse(0.3, {0, 0, 2.8}, {0, 4, 0}, {5, 0, 0});
  scene.diffuse(0.3, {0, 0, 0}, {0, 0, 2.8}, {5, 0, 0});
  scene.diffuse(0.3, {0, 4, 0}, {5, 0, 0}, {0, 0, 2.8});
  scene.diffuse(0.3, {5, 0, 0}, {0, 0, 2.8}, {0, 4, 0});
  // Before the window a screen: its face shows the window, and the lamp stands above it, behind its plane.
  const std::size_t face = scene.diffuse(0.0, {1, 1, 0.5}, {0, 0, 1.5}, {0, 2, 0});
  scene.diffuse(0.0, {1.05, 1, 0.5}, {0, 2, 0}, {0, 0, 1.5});
  scene.glass(0.8, {0, 0, 0}, {0, 4, 0}, {0, 0, 2.8});
  scene.glass(0.8, {-0.02, 0, 0}, {0, 4, 0}, {0, 0, 2.8});  // double glazing
  const Vec3 lamp{1.4, 2, 2.6};
  LightSpec spec;
  spec.luminaires = {test::point_lamp(lamp, 100)};
  PhotonTracer exact = scene.tracer();
  exact.follow(4'000'000, 100, [&](PhotonTracer::Random& random) { return from_lamp(lamp, random); });
  compare(scene, spec, exact, {{"floor", 0}, {"face", face}},
          {Method::progressive, Method::gauss_seidel, Method::path, Method::bidirectional, Method::particles});
}

TEST(Reflection, ALiftBetweenTwoMirrors) {
  Twice scene(0.25);
  const std::size_t floor = scene.diffuse(0.2, {0, 0, 0}, {1.5, 0, 0}, {0, 1.5, 0});
  scene.diffuse(0.7, {0, 0, 2.3}, {0, 1.5, 0}, {1.5, 0, 0});
  const std::size_t back = scene.diffuse(0.4, {0, 0, 0}, {0, 0, 2.3}, {1.5, 0, 0});
  scene.diffuse(0.4, {0, 1.5, 0}, {1.5, 0, 0}, {0, 0, 2.3});
  for (const double x : {0.0, 1.5}) {
    const Vec3 up{0, 0, 0.9}, along{0, x > 0 ? 1.5 : -1.5, 0}, o{x, x > 0 ? 0 : 1.5, 0};
    scene.diffuse(0.4, o, up, along);
    scene.mirror(0.88, o + up, {0, 0, 1.4}, along);
  }
  const Vec3 lamp{0.6, 0.7, 2.0};
  LightSpec spec;
  spec.luminaires = {test::point_lamp(lamp, 100)};
  PhotonTracer exact = scene.tracer();
  exact.follow(1'000'000, 100, [&](PhotonTracer::Random& random) { return from_lamp(lamp, random); });
  compare(scene, spec, exact, {{"floor", floor}, {"back", back}},
          {Method::progressive, Method::path, Method::bidirectional, Method::particles});
}

/// Irradiance at p straight from lamps and suns.
double delta_light(const PatchSet& patches, const LightSpec& spec, const Vec3& p, const Vec3& n) {
  const RayScene rays(patches);
  const Lights lights = place_lights(spec, patches, rays);
  const Problem problem{patches, rays, lights};
  return LightSampler(problem, patches.M).delta_light(p, n, {.sun_rays = 64}, 1)[0];
}
double of_lamp(double flux, const Vec3& lamp, const Vec3& p, const Vec3& n) {
  const Vec3 d = lamp - p;
  return flux / (4 * kPi) * std::max(0.0, dot(n, d)) / std::pow(length(d), 3);
}

TEST(Reflection, TheSunOffAPaneOntoTheGround) {
  for (const double degrees : {10.0, 45.0, 75.0}) {  // of incidence
    const double sine = std::sin(degrees * kPi / 180), cosine = std::cos(degrees * kPi / 180);
    // A pane upright in x = 0; the sun before it, and a point of the ground that the turned light meets.
    PatchBuilder b(0.0);
    b.rectangle({0, -50, 0}, {60, 0, 0}, {0, 100, 0}).glass(0.7).rectangle({0, -50, 0}, {0, 100, 0}, {0, 0, 60});
    const PatchSet patches = b.build();
    LightSpec spec;
    spec.suns = {{{cosine, 0, sine}, Spectrum(1000)}};
    const double expected = 1000 * sine * (1 + sheet_shares(fit_glass_sheet(0.7), cosine).reflectance);
    EXPECT_NEAR(delta_light(patches, spec, {2, 0, 1e-3}, {0, 0, 1}) / expected, 1, 2e-3) << degrees;
    // Behind it stands nothing: there the sun comes through the pane alone.
    const double behind = delta_light(patches, spec, {-0.5, 0, 1}, {1, 0, 0});
    EXPECT_NEAR(behind / (1000 * cosine * sheet_shares(fit_glass_sheet(0.7), cosine).transmittance), 1, 2e-3);
  }
}

TEST(Reflection, ALampInAPaneBeforeAPane) {
  // Two panes 0.1 m apart: the lamp in the first, and through it in the second, there and back.
  PatchBuilder b(0.0);
  b.rectangle({4, -20, -20}, {0, 0, 40}, {0, 40, 0});
  b.glass(0.8).rectangle({0, -20, -20}, {0, 40, 0}, {0, 0, 40}).rectangle({-0.1, -20, -20}, {0, 40, 0}, {0, 0, 40});
  LightSpec spec;
  const Vec3 lamp{1, 0, 0}, p{2, 1, 0.5}, n{-1, 0, 0};
  spec.luminaires = {test::point_lamp(lamp, 100)};
  double expected = of_lamp(100, lamp, p, n);
  const GlassSheet sheet = fit_glass_sheet(0.8);
  for (const auto& [x, passes_first, between] : {std::tuple{-1.0, 0, 1}, {-1.2, 2, 1}, {-1.4, 2, 3}}) {
    const Vec3 image{x, 0, 0};
    const SheetShares shares = sheet_shares(sheet, (p.x - image.x) / length(p - image));
    expected += of_lamp(100, image, p, n) * std::pow(shares.transmittance, passes_first) *
                std::pow(shares.reflectance, between);
  }
  EXPECT_NEAR(delta_light(b.build(), spec, p, n) / expected, 1, 2e-3);
}

TEST(Reflection, ALampBetweenTwoMirrorsHasARowOfImages) {
  constexpr double kRho = 0.9, kApart = 1.5;
  PatchBuilder b(0.0);
  b.rectangle({0, -20, -20}, {kApart, 0, 0}, {0, 40, 0});
  b.mirror(kRho).rectangle({0, -20, -20}, {0, 40, 0}, {0, 0, 40}).rectangle({kApart, -20, -20}, {0, 40, 0}, {0, 0, 40});
  LightSpec spec;
  const Vec3 lamp{0.5, 0, 0}, p{1.0, 0.3, -2}, n{0, 0, 1};
  spec.luminaires = {test::point_lamp(lamp, 100)};
  double expected = 0;
  for (int k = -200; k <= 200; ++k) {  // lamps at 2 k a + x over 2 |k| mirrors, at 2 k a - x over |2 k - 1|
    expected += std::pow(kRho, std::abs(2 * k)) * of_lamp(100, {2 * k * kApart + lamp.x, 0, 0}, p, n);
    expected += std::pow(kRho, std::abs(2 * k - 1)) * of_lamp(100, {2 * k * kApart - lamp.x, 0, 0}, p, n);
  }
  // Fifteen planes on either side: what is beyond them is 0.1 % here.
  EXPECT_NEAR(delta_light(b.build(), spec, p, n) / expected, 1, 5e-3);
}

/// A closed room with a lamp, and in it a closed cube of panes with a small tray and another lamp.
PatchSet cube_of_panes(double transmittance) {
  PatchBuilder b(0.5);
  b.box({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {4, 4, 4}, true);
  b.rectangle({0.7, 0.7, 0.6}, {0.4, 0, 0}, {0, 0.4, 0}, 8, 8);
  b.glass(transmittance).box({0.5, 0.5, 0.5}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, true);
  return b.build();
}

bool is_of_tray(const PatchSet& patches, PatchId i) {
  const auto c = patches.corner_positions(i);
  return std::max(std::abs(c[0].z - 0.6), std::abs(c[1].z - 0.6)) < 1e-9;
}

TEST(OneWay, BringsWhatRaysAndAllTheirEchoesBring) {
  for (const double T : {0.0, 1e-7, 0.3, 0.9}) {
    const PatchSet patches = cube_of_panes(T);
    const RayScene rays(patches);
    constexpr std::uint64_t kCount = 200'000;
    double all = 0, one = 0, square_all = 0, square_one = 0;  // of what gets to the tray
    const auto at_tray = [&](const Hit& hit) {
      return hit.patch.valid() && is_of_tray(patches, hit.patch) ? hit.transmittance[0] / kCount : 0.0;
    };
    for (std::uint64_t k = 0; k < kCount; ++k) {
      RandomStream random(7, k);
      const double z = 1 - 2 * random.uniform(), phi = 2 * kPi * random.uniform(), r = std::sqrt(1 - z * z);
      const Ray ray{{1, 1, 0.9}, {r * std::cos(phi), r * std::sin(phi), z}};
      Echo echo;
      double of_all = at_tray(rays.first_hit(patches, ray, &echo));
      if (!echo.is_none()) follow_echo(rays, patches, echo, random, [&](const Hit& h) { of_all += at_tray(h); });
      const double of_one = at_tray(one_way(rays, patches, ray, random));
      all += of_all, square_all += of_all * of_all, one += of_one, square_one += of_one * of_one;
    }
    const double error = std::sqrt(square_all - all * all / kCount + square_one - one * one / kCount);
    EXPECT_LT(error, 0.02 * all);
    EXPECT_NEAR(one, all, 4 * error) << T;
  }
}

class CubeOfPanes : public testing::TestWithParam<Method> {};

TEST_P(CubeOfPanes, LightInItEndsThoughTheyLetNothingPass) {
  for (const double T : {0.0, 1e-7}) {
    const PatchSet patches = cube_of_panes(T);
    const RayScene rays(patches);
    LightSpec spec;
    spec.luminaires = {test::point_lamp({1, 1, 0.9}, 100), test::point_lamp({1, 1, 1.8}, 100)};
    const Lights lights = place_lights(spec, patches, rays);
    const Solution s = solve_on_patches({patches, rays, lights}, {.method = GetParam()});
    EXPECT_NEAR(s.energy.imbalance(), 0, 0.01) << T;
    // On the tray: the lamp, and its images in the panes beside and above it. Over two panes comes a thousandth of it.
    const GlassSheet sheet = fit_glass_sheet(T);
    constexpr int kGrid = 64;
    double expected = 0, found = 0;
    for (int k = 0; k < kGrid * kGrid; ++k) {
      const Vec3 x{0.7 + 0.4 * (k % kGrid + 0.5) / kGrid, 0.7 + 0.4 * (k / kGrid + 0.5) / kGrid, 0.6};
      double E = of_lamp(100, {1, 1, 0.9}, x, {0, 0, 1});
      for (const auto& [image, across] : {std::pair{Vec3{0, 1, 0.9}, Vec3{1, 0, 0}},
                                          {{2, 1, 0.9}, {1, 0, 0}},
                                          {{1, 0, 0.9}, {0, 1, 0}},
                                          {{1, 2, 0.9}, {0, 1, 0}},
                                          {{1, 1, 2.1}, {0, 0, 1}}})
        E += of_lamp(100, image, x, {0, 0, 1}) *
             sheet_shares(sheet, std::abs(dot(normalized(x - image), across))).reflectance;
      expected += 0.16 / (kGrid * kGrid) * E;
    }
    for (std::size_t i = 0; i < patches.patch_count(); ++i)
      if (is_of_tray(patches, PatchId{i})) found += patches.area[i] * s.E[i][0];
    // Of 32,768 particles one in ten lands on the tray.
    EXPECT_NEAR(found / expected, 1, GetParam() == Method::particles ? 2e-2 : 3e-3) << T;
  }
}
INSTANTIATE_TEST_SUITE_P(Methods, CubeOfPanes,
                         testing::Values(Method::progressive, Method::path, Method::bidirectional, Method::particles));

TEST(Reflection, TheShareOfAnImageIsWhatIsLeftOnItsWay) {
  PatchBuilder b(0.0);
  b.rectangle({0, -20, -20}, {1, 0, 0}, {0, 40, 0});
  b.mirror(0.5).rectangle({0, -20, -20}, {0, 40, 0}, {0, 0, 40}).rectangle({1, -20, -20}, {0, 40, 0}, {0, 0, 40});
  const PatchSet patches = b.build();
  LightSpec spec;
  spec.luminaires = {test::point_lamp({0.5, 0, 0}, 100)};
  const Lights lights = place_lights(spec, patches, RayScene(patches));
  std::size_t longest = 0;
  for (const PlacedLuminaire& luminaire : lights.luminaires) {
    EXPECT_NEAR(luminaire.share, std::pow(0.5, luminaire.way.count), 1e-9);
    longest = std::max<std::size_t>(longest, luminaire.way.count);
  }
  EXPECT_GT(longest, 3u);
}

TEST(Reflection, WhatFacetsWithoutImagesTurnOfTheSunIsToldAsLost) {
  // A row of panes, each in a plane of its own, of equal size and equally lit: 64 of them have images. Of mirrors
  // particles go on.
  for (const int facets : {60, 128}) {
    PatchBuilder b(0.0);
    b.glass(0.8);
    for (int k = 0; k < facets; ++k) {
      const double turned = (k - facets / 2) * 1e-3;
      b.rectangle({2.0 * k, 0, 0}, {std::cos(turned), 0, std::sin(turned)}, {0, 1, 0});
    }
    const PatchSet patches = b.build();
    LightSpec spec;
    spec.suns = {{{0, 0.6, 0.8}, Spectrum(1000)}};
    const Lights lights = place_lights(spec, patches, RayScene(patches));
    const double turned = GlassTable(Spectrum(0.8)).reflectance(0.8)[0];
    EXPECT_NEAR(lights.lost_in_mirrors, facets > 64 ? turned * (facets - 64) / facets : 0.0, 5e-3) << facets;
  }
}

TEST(Reflection, ASurfaceThatAnImageOfTheSunMayNotReachGetsNothingOfIt) {
  // Mirrors all around that lean inwards, and a street between two: images over one and over several.
  PatchBuilder b(0.0);
  b.rectangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});
  b.mirror(0.9);
  for (int k = 0; k < 12; ++k) {
    const double phi = 2 * kPi * k / 12;
    const Vec3 out{std::cos(phi), std::sin(phi), 0}, along{-out.y, out.x, 0};
    b.rectangle(Vec3{2, 2, 0.2} + out * 3 - along * 0.7, along * 1.4, Vec3{0, 0, 2} - out * 0.2);
  }
  b.rectangle({1.5, 0, 0}, {0, 3, 0}, {0, 0, 2}).rectangle({2.5, 0, 0}, {0, 3, 0}, {0.05, 0, 2});
  const PatchSet patches = b.build();
  const RayScene rays(patches);
  LightSpec spec;
  spec.suns = {{normalized({0.6, 0.1, 0.6}), Spectrum(1000)}};
  const Lights lights = place_lights(spec, patches, rays);
  int reached = 0, skipped = 0, over_several = 0;
  for (std::uint64_t t = 0; t < 400; ++t) {
    RandomStream random(3, t);
    const Vec3 at{4 * random.uniform(), 4 * random.uniform(), 1.5 * random.uniform()};
    std::array<Vec3, 3> corners;
    for (Vec3& c : corners) c = at + Vec3{random.uniform(), random.uniform(), random.uniform()} * 0.4;
    for (const PlacedSun& sun : lights.suns) {
      const bool may = may_reach(rays, sun, corners);
      EXPECT_TRUE(may || sun.is_image());
      bool gets = false;
      for (std::uint32_t k = 0; k < 64; ++k) {
        const auto u = sobol4(k, t);
        const Vec3 p = point_on_triangle(corners, u[0], u[1]);
        const Vec3 far = p + direction_to_sun(sun, u[2], u[3]) * (4 * rays.diameter());
        gets = gets || (sun.is_image() && !rays.transmittance_by_mirrors(p, far, sun.way).is_black());
      }
      EXPECT_TRUE(may || !gets) << "over " << int{sun.way.count};
      reached += gets, over_several += gets && sun.way.count > 1, skipped += !may;
    }
  }
  EXPECT_GT(reached, 100);
  EXPECT_GT(over_several, 5);
  EXPECT_GT(skipped, 4 * reached);
}

class WhiteCavity : public testing::TestWithParam<Method> {};

TEST_P(WhiteCavity, KeepsItsLightAroundAPaneThatAbsorbsNothing) {
  PatchBuilder b(0.5);
  b.material(0.5, 10).box({0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 0, 1}, {8, 4, 4}, true);
  b.glass(kClearGlass).rectangle({0.7, 0, 0}, {0, 1, 0}, {0, 0, 1});
  const PatchSet patches = b.build();
  const RayScene rays(patches);
  const Lights none;
  const Solution s = solve_on_patches({patches, rays, none}, {.method = GetParam()});
  double worst = 0;
  for (std::size_t i = 0; i < patches.patch_count(); ++i) worst = std::max(worst, std::abs(s.B[i][0] / 20 - 1));
  EXPECT_LT(worst, is_by_paths(GetParam()) ? 0.15 : 0.05);
  EXPECT_NEAR(total_flux(patches, s.B) / (20 * patches.total_area()), 1, 2e-3);
  EXPECT_NEAR(s.energy.absorbed / s.energy.emitted, 1, 2e-3);
}
INSTANTIATE_TEST_SUITE_P(Methods, WhiteCavity,
                         testing::Values(Method::progressive, Method::gauss_seidel, Method::path,
                                         Method::bidirectional));

}  // namespace
}  // namespace clerestory
