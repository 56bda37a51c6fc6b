// Figures of a year: worked by hand, and every row of ../shared/reference/annual where that is there.

#include "solver/evaluate/annual_figures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/support/csv_rows.h"

namespace clerestory {
namespace {

/// Occupied from 8 to 18 h every day, 3,650 hours.
std::vector<std::uint8_t> eight_to_eighteen() {
  std::vector<std::uint8_t> occupied(kHoursOfYear);
  for (std::size_t h = 0; h < occupied.size(); ++h) occupied[h] = h % 24 >= 8 && h % 24 < 18;
  return occupied;
}

/// Hours from 6 to 20 of every day, 5,110, with the most light in the middle of it.
struct LitHours {
  LitHours() {
    for (int h = 0; h < 8760; ++h)
      if (h % 24 >= 6 && h % 24 < 20) hours.push_back(h), diffuse.push_back(10 - std::abs(h % 24 - 12.6));
  }
  YearRules rules() const { return year_rules(hours, diffuse, eight_to_eighteen(), 300, {200, 400}); }
  /// Of one illuminance from 6 to 12 and another from 12 to 20.
  std::vector<float> lux(float morning, float afternoon) const {
    std::vector<float> values;
    for (const int h : hours) values.push_back(h % 24 < 12 ? morning : afternoon);
    return values;
  }

  std::vector<int> hours;
  std::vector<double> diffuse;
};

double figure(const std::string& name, const PointYear& point, const YearRules& rules) {
  for (const YearFigure& f : year_figures(rules))
    if (f.name == name) return f(point, rules);
  ADD_FAILURE() << "no figure " << name;
  return -1;
}

TEST(YearRules, DaylightHoursAreTheHalfOfTheYearWithMostDiffuseLightAndTheEarlierOfEqualOnes) {
  const LitHours lit;
  const YearRules rules = lit.rules();
  EXPECT_EQ(rules.occupied_hours, 3650);
  EXPECT_EQ(std::accumulate(rules.occupied.begin(), rules.occupied.end(), 0.0), 3650);
  EXPECT_EQ(std::accumulate(rules.daylight.begin(), rules.daylight.end(), 0.0), 4380);
  // 365 days of 12 hours: those from 7 to 19; 6:00 is 6.6 from the brightest, 19:00 is 6.4, 18:00 is 5.4.
  for (std::size_t i = 0; i < lit.hours.size(); ++i)
    EXPECT_EQ(rules.daylight[i], lit.hours[i] % 24 >= 7 && lit.hours[i] % 24 < 19) << lit.hours[i];

  const std::vector<double> alike(lit.hours.size(), 5000.0);
  const YearRules first = year_rules(lit.hours, alike, eight_to_eighteen());
  for (std::size_t i = 0; i < alike.size(); ++i) EXPECT_EQ(first.daylight[i], i < 4380) << i;
}

TEST(FiguresOf, APointWithTwoIlluminancesADayIsWorkedByHand) {
  const LitHours lit;
  const YearRules rules = lit.rules();
  // Occupied: 4 hours of 150 lx and 6 of 3,600 a day; daylight hours of EN 17037: 5 and 7.
  const PointYear point = figures_of(lit.lux(150, 3600), lit.lux(0, 1100), rules);
  EXPECT_DOUBLE_EQ(figure("DA_300", point, rules), 60);
  EXPECT_DOUBLE_EQ(figure("cDA_300", point, rules), 80);
  EXPECT_DOUBLE_EQ(figure("UDI_lower", point, rules), 0);
  EXPECT_DOUBLE_EQ(figure("UDI", point, rules), 40);
  EXPECT_DOUBLE_EQ(figure("UDI_upper", point, rules), 60);
  EXPECT_EQ(figure("ASE_hours", point, rules), 6 * 365);
  EXPECT_DOUBLE_EQ(figure("mean_illuminance", point, rules), 0.4 * 150 + 0.6 * 3600);
  EXPECT_DOUBLE_EQ(figure("EN17037_100", point, rules), 100);
  EXPECT_DOUBLE_EQ(figure("EN17037_750", point, rules), 100 * 7 / 12.0);
  EXPECT_EQ(figure("hours_200", point, rules), 6 * 365);
}

TEST(FiguresOf, HoursWithoutLightStayInTheDivisor) {
  const std::vector<int> noon = {12, 36};
  const std::vector<double> diffuse = {9000, 8000};
  const YearRules rules = year_rules(noon, diffuse, eight_to_eighteen());
  const PointYear point = figures_of(std::vector<float>{300, 300}, {}, rules);
  EXPECT_DOUBLE_EQ(figure("DA_300", point, rules), 100 * 2 / 3650.0);
  EXPECT_DOUBLE_EQ(figure("UDI_lower", point, rules), 100 * 3648 / 3650.0);
  EXPECT_DOUBLE_EQ(figure("EN17037_300", point, rules), 100 * 2 / 4380.0);
}

TEST(FiguresOf, LimitsBelongToTheSideThatTheRulesSay) {
  const std::vector<int> noon = {12};
  const std::vector<double> diffuse = {9000};
  const YearRules rules = year_rules(noon, diffuse, eight_to_eighteen());
  const auto at = [&](float lux) { return figures_of(std::vector<float>{lux}, std::vector<float>{lux}, rules); };
  EXPECT_EQ(at(300).DA, 1);
  EXPECT_EQ(at(std::nextafter(300.0f, 0.0f)).DA, 0);
  EXPECT_EQ(at(100).UDI_lit, 1);
  EXPECT_EQ(at(3000).UDI_upper, 0);
  EXPECT_EQ(at(std::nextafter(3000.0f, 1e9f)).UDI_upper, 1);
  EXPECT_EQ(at(1000).ASE, 0);
  EXPECT_EQ(at(std::nextafter(1000.0f, 1e9f)).ASE, 1);
}

TEST(FiguresOf, BoundsAreWhatTheIlluminancesGiveWhenAllAreWrongByTheirError) {
  const LitHours lit;
  const YearRules rules = lit.rules();
  std::vector<float> total, direct;
  for (std::size_t i = 0; i < lit.hours.size(); ++i) {
    total.push_back(static_cast<float>((i * 7919) % 1000));
    direct.push_back(static_cast<float>((i * 6101) % 2000));
  }
  const auto scaled = [](std::vector<float> lux, float factor) {
    for (float& E : lux) E *= factor;
    return lux;
  };
  const PointYear point = figures_of(total, direct, rules, {.total = 0.125, .direct = 0.25});
  EXPECT_EQ(point.DA_low, figures_of(scaled(total, 0.875f), direct, rules).DA);
  EXPECT_EQ(point.DA_high, figures_of(scaled(total, 1.125f), direct, rules).DA);
  EXPECT_EQ(point.ASE_low, figures_of(total, scaled(direct, 0.75f), rules).ASE);
  EXPECT_EQ(point.ASE_high, figures_of(total, scaled(direct, 1.25f), rules).ASE);
  EXPECT_LT(point.DA_low, point.DA);
  EXPECT_GT(point.ASE_high, point.ASE);
  const PointYear unsure = figures_of(total, direct, rules, {.total = 1, .direct = 1.5});
  EXPECT_EQ(unsure.DA_low, 0);
  EXPECT_EQ(unsure.ASE_low, 0);
  EXPECT_EQ(unsure.DA, point.DA);
}

TEST(AreaYear, CountsAreaAndNotPointsAndTellsBothRulesOfAse) {
  const LitHours lit;
  const YearRules rules = lit.rules();
  PointYear half, sunny, dark;
  half.DA = half.DA_low = half.DA_high = 1825;
  half.ASE = half.ASE_low = half.ASE_high = 250;
  sunny = half;
  sunny.DA_low = 1824;
  sunny.ASE = sunny.ASE_high = 251;
  dark.DA = 1824, dark.DA_high = 1825;
  const AreaYear room = area_year(std::vector{half, sunny, dark}, std::vector{2.0, 1.0, 1.0}, rules);
  EXPECT_DOUBLE_EQ(room.sDA.value, 75);
  EXPECT_DOUBLE_EQ(room.sDA.low, 50);
  EXPECT_DOUBLE_EQ(room.sDA.high, 100);
  EXPECT_DOUBLE_EQ(room.ASE_at_least.value, 75);
  EXPECT_DOUBLE_EQ(room.ASE_more_than.value, 25);
  EXPECT_DOUBLE_EQ(room.ASE_more_than.low, 0);
  EXPECT_EQ(leed_points(room.sDA.value), 3);
  EXPECT_EQ(leed_points(39.9), 0);
  EXPECT_EQ(leed_points(40), 1);
  EXPECT_EQ(leed_points(55), 2);
}

TEST(AreaYear, ALevelOfEn17037NeedsTheTargetOnHalfAndTheMinimumOnNearlyAllOfTheArea) {
  const YearRules rules = LitHours().rules();
  PointYear high, edge;
  high.EN17037 = {4380, 4380, 4380, 2190};
  edge.EN17037 = {2190, 2190, 100, 0};
  const auto level = [&](std::size_t high_points, std::size_t edge_points) {
    std::vector<PointYear> points(high_points, high);
    points.resize(high_points + edge_points, edge);
    points.resize(20, PointYear{});
    return area_year(points, std::vector(20, 0.05), rules).level;
  };
  EXPECT_EQ(level(20, 0), En17037Level::high);
  EXPECT_EQ(level(19, 0), En17037Level::high);
  EXPECT_EQ(level(10, 9), En17037Level::medium);
  EXPECT_EQ(level(9, 11), En17037Level::minimum);
  EXPECT_EQ(level(18, 0), En17037Level::none);
}

// ---- ../shared/reference/annual ----

TEST(AnnualReference, EveryRowIsMetExactly) {
  const std::filesystem::path folder = std::filesystem::path(CLERESTORY_SOURCE_DIR) / "../shared/reference/annual";
  const auto rows = test::csv_rows(folder / "hours.csv");
  if (rows.empty()) GTEST_SKIP() << "no " << folder;
  ASSERT_EQ(rows.size(), kHoursOfYear);
  std::vector<int> hours;
  std::vector<double> diffuse;
  std::vector<std::vector<float>> total(6), direct(6);
  for (const auto& row : rows) {
    const auto value = [&](const std::string& name) { return std::stod(row.at(name)); };
    // As the command gives them: hours without any light are left out.
    if (value("diffuse_horizontal") == 0 && value("total_0") == 0) continue;
    hours.push_back(std::stoi(row.at("hour")) - 1);
    diffuse.push_back(value("diffuse_horizontal"));
    for (std::size_t s = 0; s < 6; ++s) {
      total[s].push_back(static_cast<float>(value("total_" + std::to_string(s))));
      if (s < 3) direct[s].push_back(static_cast<float>(value("direct_" + std::to_string(s))));
    }
  }
  ASSERT_LT(hours.size(), kHoursOfYear);
  const YearRules rules = year_rules(hours, diffuse, eight_to_eighteen(), 300, {100, 500});
  std::vector<PointYear> points;
  std::map<std::pair<std::string, std::string>, double> computed;
  const std::map<std::string, std::string> names = {
      {"UDI", "UDI_100_3000"}, {"ASE_hours", "ASE_hours_1000"}, {"mean_illuminance", "mean_occupied"}};
  for (std::size_t s = 0; s < 6; ++s) {
    points.push_back(figures_of(total[s], direct[s], rules));
    const std::string sensor = std::to_string(s);
    for (const YearFigure& f : year_figures(rules)) {
      const double value = f(points.back(), rules);
      if (f.name.starts_with("EN17037_"))
        computed[{"EN17037_share_" + f.name.substr(8), sensor}] = value;
      else if (f.name.starts_with("hours_"))
        computed[{"DA_" + f.name.substr(6), sensor}] = 100 * value / 3650;
      else
        computed[{names.contains(f.name) ? names.at(f.name) : f.name, sensor}] = value;
    }
  }
  const AreaYear room = area_year(points, std::vector{1.0, 1.0, 2.0, 2.0, 1.5, 0.5}, rules);
  computed[{"sDA_300_50", "room"}] = room.sDA.value;
  computed[{"ASE_1000_250_at_least", "room"}] = room.ASE_at_least.value;
  computed[{"ASE_1000_250_more_than", "room"}] = room.ASE_more_than.value;
  const char* const levels[] = {"minimum", "medium", "high"};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto name = [&](const char* what, std::size_t lux) {
      return std::pair{std::string("EN17037_") + levels[k] + "_area_" + what + "_" +
                           std::to_string(static_cast<int>(kEn17037Lux[lux])),
                       std::string("room")};
    };
    computed[name("target", k + 1)] = room.target_share[k];
    computed[name("minimum", k)] = room.minimum_share[k];
  }
  std::size_t met = 0;
  for (const auto& row : test::csv_rows(folder / "metrics.csv")) {
    const auto found = computed.find({row.at("metric"), row.at("sensor")});
    ASSERT_NE(found, computed.end()) << row.at("metric") << " of " << row.at("sensor");
    const double expected = std::stod(row.at("value"));
    // Counts of hours are exact. Means are of illuminances that became floats: 24 bits, 6e-8.
    const bool is_mean = row.at("metric").starts_with("cDA") || row.at("metric").starts_with("mean");
    EXPECT_NEAR(found->second, expected, is_mean ? 6e-8 * expected : 1e-13 * expected) << row.at("metric");
    ++met;
  }
  EXPECT_EQ(met, 87u);
}

}  // namespace
}  // namespace clerestory
