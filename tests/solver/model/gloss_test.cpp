#include "solver/model/gloss.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "solver/model/random_stream.h"

namespace clerestory {
namespace {

constexpr double kPi = std::numbers::pi;
const Vec3 kNormal = normalized({0.2, -0.4, 0.7});

struct Case {
  std::string name;
  Gloss gloss;
};
Gloss phong(double e) { return {Spectrum(0.6), e, 1}; }
Gloss ggx(double roughness) { return {Spectrum(0.6), {}, roughness}; }
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class LobeOf : public testing::TestWithParam<Case> {};

Vec3 at_angle(double degrees) {
  const double a = degrees * kPi / 180;
  return Frame(kNormal).to_world(std::sin(a) * std::cos(0.7), std::sin(a) * std::sin(0.7), std::cos(a));
}
constexpr double kAngles[] = {0, 25, 50, 75, 86};

/// Cells around the mirror's direction, each as thick as it is far: narrow lobes and wide ones fit. A lobe ends at a
/// right angle, where two of them meet.
struct Rings {
  static constexpr int kRings = 900, kTurns = 96, kInHalving = 40;
  static constexpr double kStep = std::numbers::ln2 / kInHalving;
  static inline const double kLeast = kPi * std::exp(-kRings * kStep);

  /// Calls visit(ring, turn, direction, solid angle).
  template <class Visit>
  static void visit(const Vec3& from, const Visit& visit) {
    const Frame frame(normalized(kNormal * (2 * dot(kNormal, from)) - from));
    for (int i = 0; i < kRings; ++i) {
      const double low = kLeast * std::exp(i * kStep), high = kLeast * std::exp((i + 1) * kStep);
      const double a = kLeast * std::exp((i + 0.5) * kStep), size = (std::cos(low) - std::cos(high)) * 2 * kPi / kTurns;
      for (int j = 0; j < kTurns; ++j) {
        const double turn = (j + 0.5) * 2 * kPi / kTurns;
        visit(i, j, frame.to_world(std::sin(a) * std::cos(turn), std::sin(a) * std::sin(turn), std::cos(a)), size);
      }
    }
  }
};

double albedo_by_quadrature(const Lobe& lobe, const Gloss& gloss, const Vec3& from) {
  double sum = 0;
  if (gloss.exponent) {
    Rings::visit(from, [&](int, int, const Vec3& d, double size) {
      if (dot(kNormal, d) > 0) sum += lobe.evaluate(kNormal, from, d)[0] * dot(kNormal, d) * size;
    });
    return sum;
  }
  // At grazing angles lobes of facets are as flat as they are narrow, but not the distribution of their normals.
  Rings::visit(kNormal, [&](int, int, const Vec3& h, double size) {
    const double along = dot(from, h);
    const Vec3 d = h * (2 * along) - from;
    if (along > 0 && dot(kNormal, d) > 0)
      sum += lobe.evaluate(kNormal, from, d)[0] * dot(kNormal, d) * 4 * along * size;
  });
  return sum;
}

TEST_P(LobeOf, HasTheAlbedoThatItsValuesSumTo) {
  const Lobe lobe(GetParam().gloss);
  for (const double degrees : kAngles) {
    const Vec3 from = at_angle(degrees);
    const double albedo = lobe.albedo(dot(kNormal, from))[0];
    EXPECT_NEAR(albedo_by_quadrature(lobe, GetParam().gloss, from), albedo, 1e-3) << degrees;
    EXPECT_LE(albedo, 0.6 * (1 + 2e-5)) << degrees;
  }
  EXPECT_NEAR(lobe.albedo(1)[0], 0.6, 1e-3);
}

TEST_P(LobeOf, IsSampledInItsDensityAndWeighedToItsAlbedo) {
  const Lobe lobe(GetParam().gloss);
  constexpr int kSamples = 100'000;
  RandomStream random(5, 6);
  for (const double degrees : {0.0, 25.0, 50.0, 75.0, 86.0, 89.5}) {
    const Vec3 from = at_angle(degrees);
    double sum = 0, squares = 0;
    for (int k = 0; k < kSamples; ++k) {
      const double u = random.uniform(), v = random.uniform();
      const Lobe::Sample s = lobe.sample(kNormal, from, u, v);
      sum += s.weight[0], squares += s.weight[0] * s.weight[0];
      if (!(s.density > 0)) continue;
      ASSERT_NEAR(length(s.direction), 1, 1e-12);
      ASSERT_GT(dot(kNormal, s.direction), 0);
    }
    const double mean = sum / kSamples, std_error = std::sqrt((squares / kSamples - mean * mean) / kSamples);
    EXPECT_LT(std_error, 3e-3) << degrees;  // no weight is far above the others
    EXPECT_NEAR(mean, lobe.albedo(dot(kNormal, from))[0], 5 * std_error + 2e-4) << degrees;
  }
}

TEST_P(LobeOf, SendsAsManySamplesIntoACellAsItsDensityHasThere) {
  const Lobe lobe(GetParam().gloss);
  constexpr int kSamples = 100'000, kWide = 30, kTurns = 8;  // rings and turns of a cell
  RandomStream random(1, 2);
  for (const double degrees : {0.0, 50.0, 75.0}) {
    const Vec3 from = at_angle(degrees);
    const Frame frame(normalized(kNormal * (2 * dot(kNormal, from)) - from));
    constexpr std::size_t kAcross = Rings::kTurns / kTurns, kCells = Rings::kRings / kWide * kAcross;
    std::vector<double> expected(kCells + 1), found(kCells + 1);
    const auto cell = [&](int ring, int turn) {
      return static_cast<std::size_t>(ring / kWide) * kAcross + static_cast<std::size_t>(turn / kTurns);
    };
    double above = 0;
    Rings::visit(from, [&](int i, int j, const Vec3& d, double size) {
      const double share = lobe.density(kNormal, from, d) * size;
      expected[cell(i, j)] += kSamples * share, above += share;
    });
    expected[kCells] = kSamples * std::max(0.0, 1 - above);
    for (int k = 0; k < kSamples; ++k) {
      const double u = random.uniform(), v = random.uniform();
      const Lobe::Sample s = lobe.sample(kNormal, from, u, v);
      if (!(s.density > 0)) {
        ++found[kCells];
        continue;
      }
      const double x = dot(s.direction, frame.t), y = dot(s.direction, frame.b), z = dot(s.direction, frame.n);
      const double a = std::atan2(std::hypot(x, y), z), turn = std::atan2(y, x) / (2 * kPi);
      const int ring = static_cast<int>(std::log(std::max(a, Rings::kLeast) / Rings::kLeast) / Rings::kStep);
      ++found[cell(std::min(ring, Rings::kRings - 1),
                   std::min(static_cast<int>((turn < 0 ? turn + 1 : turn) * Rings::kTurns), Rings::kTurns - 1))];
    }
    double chi2 = 0, rest_expected = 0, rest_found = 0;
    int freedom = 0;
    const auto add = [&](double e, double f) { chi2 += (f - e) * (f - e) / e, ++freedom; };
    for (std::size_t k = 0; k <= kCells; ++k) {
      if (expected[k] > 20)
        add(expected[k], found[k]);
      else
        rest_expected += expected[k], rest_found += found[k];
    }
    if (rest_expected > 20) add(rest_expected, rest_found);
    // Five standard deviations of chi-square, and what the midpoints of cells at the horizon miss.
    EXPECT_LT(chi2, freedom + 5 * std::sqrt(2.0 * freedom) + 12) << degrees << ", " << freedom << " cells";
  }
}

TEST_P(LobeOf, IsReciprocalAndNothingBelowTheSurface) {
  const Lobe lobe(GetParam().gloss);
  RandomStream random(3, 4);
  const Frame frame(kNormal);
  for (int k = 0; k < 1000; ++k) {
    const auto direction = [&] {
      const double z = 2 * random.uniform() - 1, turn = 2 * kPi * random.uniform(), r = std::sqrt(1 - z * z);
      return frame.to_world(r * std::cos(turn), r * std::sin(turn), z);
    };
    const Vec3 a = direction(), b = direction();
    const double f = lobe.evaluate(kNormal, a, b)[0];
    EXPECT_NEAR(f, lobe.evaluate(kNormal, b, a)[0], 1e-9 * std::abs(f));
    EXPECT_GE(f, 0);
    if (dot(a, kNormal) < 0 || dot(b, kNormal) < 0) {
      EXPECT_EQ(f, 0);
      EXPECT_EQ(lobe.density(kNormal, a, b), 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Gloss, LobeOf,
                         testing::Values(Case{"phong0", phong(0)}, Case{"phong1", phong(1)}, Case{"phong20", phong(20)},
                                         Case{"phong1000", phong(1000)}, Case{"phong100000", phong(1e5)},
                                         Case{"ggx0_05", ggx(0.05)}, Case{"ggx0_2", ggx(0.2)}, Case{"ggx0_5", ggx(0.5)},
                                         Case{"ggx0_8", ggx(0.8)}, Case{"ggx1", ggx(1)}),
                         [](const auto& c) { return c.param.name; });

TEST(Lobe, PhongIsTheDiffuseSurfaceOfItsAlbedoNowhereAndTheMirrorInTheLimit) {
  // At exponent 0 the lobe is even over the half of all directions around the mirror's, and so 1 / pi times its albedo
  // at normal incidence; there all of them are above the surface.
  const Lobe even(phong(0));
  EXPECT_NEAR(even.evaluate(kNormal, kNormal, at_angle(40))[0], 0.6 / kPi, 1e-12);
  // Albedo of Phong by the sources' closed form: specular at normal incidence; half of that and the cosine's share of
  // the other half is left at grazing of a narrow lobe.
  const Lobe narrow(phong(1e5));
  EXPECT_NEAR(narrow.albedo(std::cos(60 * kPi / 180))[0], 0.6 * 0.5, 0.6 * 1e-4);
}

}  // namespace
}  // namespace clerestory
