#include <algorithm>
#include <cmath>

#include "io/page/html_table.h"
#include "io/page/plan_data.h"
#include "io/text.h"
#include "pipeline/report/page_sections.h"
#include "pipeline/report/plans.h"
#include "pipeline/wording.h"
#include "solver/evaluate/sensor_summary.h"

namespace clerestory {
namespace {

constexpr std::size_t kMostPlans = 60, kMostPlanBytes = 6'000'000;  ///< more can hardly be opened, and not be read
constexpr std::size_t kMostSets = 300;
constexpr std::size_t kMostFloors = 8;

/// set  number of the set of sensors in the table above
std::string figure_of(const Plan& plan, const std::string& caption, std::size_t& plans, const std::string& name,
                      std::optional<std::size_t> set = {}) {
  ++plans;
  return "<figure>\n" + svg_of(plan, plans) + "<figcaption>" + xml_text(caption) + "</figcaption>\n" +
         plan_data(plan, plans, name, set) + "</figure>\n";
}

/// What the lines of a plan mean.
std::string key_of(const Plan& plan) {
  std::string key = plan.lattice ? "Colours: illuminance" : "Dots: illuminance at each point";
  key += plan.by_logarithm ? ", by its logarithm" : "";
  if (!plan.isolux.empty()) key += "; black lines: equal illuminance, in lux";
  if (plan.target &&
      std::ranges::any_of(plan.isolux, [&](const Plan::Isolux& line) { return line.lux == *plan.target; }))
    key += "; white line: the target";
  if (!plan.walls.empty()) key += "; dark lines: walls and furniture where the plane cuts them";
  if (!plan.panes.empty()) key += "; blue: glass";
  if (!plan.luminaires.empty()) key += "; yellow discs: luminaires";
  return key + ".";
}

std::string kind_words(SensorKind kind) {
  switch (kind) {
    case SensorKind::cylindrical:
      return "Cylindrical illuminance, on upright cylinders. ";
    case SensorKind::vertical:
      return "Vertical illuminance. ";
    case SensorKind::camera:
      return "Illuminance towards a camera. ";
    case SensorKind::planar:
    case SensorKind::horizontal:
      break;
  }
  return "";
}

std::string verdict_on(const SensorSummary& s) {
  if (!s.threshold) return "";
  const double target = s.threshold->lux;
  const bool met = s.mean >= target;
  return text("<p class=\"verdict\"><span class=\"", met ? "met" : "missed", "\">",
              met ? "mean at or above" : "mean below", " the target</span> <span>The mean is ", lux_words(s.mean),
              " lx where ", lux_words(target), " lx are asked for; ", percent(s.threshold->share),
              " of the points have ", lux_words(target), " lx or more.</span></p>\n");
}

}  // namespace

std::vector<SensorSummary> summaries_of(const WrittenResult& result, const ReportTargets& targets) {
  std::vector<SensorSummary> sets;
  for (const MeasuredSensors& sensors : result.around.sensors) {
    if (sensors.illuminance.empty()) continue;
    SensorSet set{.name = sensors.set.name, .points = {}, .kind = sensors.set.kind, .threshold = sensors.set.threshold};
    if (targets.of_all) set.threshold = targets.of_all;
    if (const auto own = targets.of_set.find(set.name); own != targets.of_set.end()) set.threshold = own->second;
    // As solve says it: daylight factors are those of planes.
    sets.push_back(summary_of(set, sensors.illuminance, result.around.daylight_reference));
  }
  return sets;
}

std::string sensor_section(const WrittenResult& result, const std::vector<SensorSummary>& sets, std::size_t& plans) {
  const bool targets = std::ranges::any_of(sets, [](const SensorSummary& s) { return s.threshold.has_value(); });
  const bool daylit = result.around.daylight_reference.has_value();
  std::vector<std::string> heads = {"<sensors", "points", "mean lx", "min lx", "max lx", "median lx", "U0"};
  if (targets) heads.insert(heads.end(), {"target lx", "at or above"});
  if (daylit) heads.insert(heads.end(), {"DF mean", "DF median", "DF 2 % or more"});
  HtmlTable table(heads);
  for (std::size_t i = 0; i < std::min(sets.size(), kMostSets); ++i) {
    const SensorSummary& s = sets[i];
    std::vector<std::string> row = {s.name,           grouped(s.points),   lux_words(s.mean),        lux_words(s.min),
                                    lux_words(s.max), lux_words(s.median), ratio_words(s.uniformity)};
    if (targets && s.threshold)
      row.insert(row.end(), {lux_words(s.threshold->lux), percent(s.threshold->share)});
    else if (targets)
      row.insert(row.end(), {"", ""});
    if (daylit && s.daylight_factor)
      row.insert(row.end(), {rounded(s.daylight_factor->mean) + " %", rounded(s.daylight_factor->median) + " %",
                             percent(s.daylight_factor->share)});
    table.add(row);
  }
  std::string out = "<section class=\"reacts\">\n<h2 id=\"sensors\">Illuminance at sensors</h2>\n" + table.html();
  if (sets.size() > kMostSets)
    out += "<p class=\"soft\">" + and_more(sets.size() - kMostSets) + " sets of sensors.</p>\n";
  out += "<p class=\"soft\">U0 is the uniformity, least over mean illuminance.";
  if (daylit) out += " DF is the daylight factor, the share of the illuminance on open ground.";
  out += "</p>\n";
  std::size_t shown = 0, at = 0;
  for (const MeasuredSensors& sensors : result.around.sensors) {
    if (sensors.illuminance.empty()) continue;
    const SensorSummary& s = sets[at++];
    if (shown == kMostPlans || out.size() > kMostPlanBytes) continue;
    ++shown;
    const Plan plan = plan_of(result, sensors, s.threshold ? std::optional(s.threshold->lux) : std::optional<double>());
    out += "<h3>" + xml_text(s.name) + "</h3>\n" + verdict_on(s) +
           figure_of(plan, kind_words(s.kind) + key_of(plan), plans, s.name, at - 1);
  }
  if (at > shown) out += "<p class=\"soft\">Plans " + and_more(at - shown) + " are left out.</p>\n";
  return out + "</section>\n";
}

std::string floor_section(const WrittenResult& result, std::size_t& plans) {
  const std::vector<FloorPlan> floors = floor_plans(result, kMostFloors);
  if (floors.empty()) return {};
  std::string out =
      "<section class=\"reacts\">\n<h2 id=\"floors\">Floors</h2>\n<p>The scene has no sensors. These are the "
      "horizontal surfaces where "
      "most of "
      "them lie.</p>\n";
  for (const FloorPlan& floor : floors)
    out += text("<h3>At ", std::round(100 * floor.height) / 100 + 0.0, " m</h3>\n",
                figure_of(floor.plan, area_words(floor.area) + " m2. " + key_of(floor.plan), plans, floor.plan.title));
  return out + "</section>\n";
}

}  // namespace clerestory
