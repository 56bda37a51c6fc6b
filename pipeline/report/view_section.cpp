#include <algorithm>
#include <cmath>

#include "io/page/plan.h"
#include "io/page/solution_data.h"
#include "io/text.h"
#include "pipeline/report/page_sections.h"
#include "pipeline/wording.h"
#include "solver/model/inner_rooms.h"

namespace clerestory {
namespace {

/// Colours from the least to the most of what most of the rooms have [lx]: 2 % and 99 % of their points, or to the
/// brightest where that is not much brighter.
std::pair<double, double> range_of(const WrittenResult& r) {
  std::vector<float> lux;
  const std::vector<float>& all = r.of_points.at("illuminance").value;
  const std::vector<bool> inner = inner_rooms(r);
  const auto take = [&](bool outdoors) {
    for (std::size_t i = 0; i < r.triangles.size(); ++i)
      if (outdoors || r.room.empty() || inner[r.room[i]])
        for (const std::uint32_t p : r.triangles[i])
          if (all[p] > 0) lux.push_back(all[p]);
  };
  take(false);
  if (lux.empty()) take(true);
  if (lux.empty()) return {1, 1000};
  const auto at = [&](double share) {
    const auto place = lux.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(lux.size() - 1));
    std::nth_element(lux.begin(), place, lux.end());
    return double{*place};
  };
  const double most = at(1), usual = at(0.99), low = at(0.02);
  const double high = most < 2 * usual ? most : usual;
  // Two digits: they stand in fields that one can change.
  const auto round_to = [](double x) {
    const double step = std::pow(10, std::floor(std::log10(x)) - 1);
    return step >= 1 ? std::round(x / step) * step : std::round(x * std::round(1 / step)) / std::round(1 / step);
  };
  return high > 1.05 * low ? std::pair(round_to(std::max(low, high / 1000)), round_to(high))
                           : std::pair(low / 10, high);
}

}  // namespace

std::string view_section(const WrittenResult& result, const PageFiles& files) {
  std::string out = "<section class=\"reacts\">\n<h2 id=\"view-3d\">3D view</h2>\n";
  if (files.viewer.empty()) return out + "<p class=\"soft\">This page was made without the 3D view.</p>\n</section>\n";
  const auto [low, high] = range_of(result);
  const std::vector<double> levels = isolux_levels(low, high);
  const SolutionData data = solution_data(result, levels, low, high);
  std::string parts;
  for (const std::string& part : data.parts) parts += "<option>" + xml_text(part) + "</option>";
  out += text(
      "<p class=\"screen\">Drag to turn, use the wheel to come nearer, drag with the right button to move. Click a "
      "surface to "
      "read its illuminance. Sides that are turned away are left out, so that one sees into rooms.</p>\n"
      "<noscript><style>#view { display: none; }</style><p class=\"warning\">The 3D view needs JavaScript; all else on "
      "this page does not.</p></noscript>\n"
      "<div id=\"view\">\n<div class=\"bar\">\n"
      "<label>Show <select id=\"view-show\"><option value=\"false\">illuminance</option><option value=\"seen\">as it "
      "is seen</option></select></label>\n<label>Room <select id=\"view-part\">",
      parts, "</select></label>\n<label>from <input id=\"view-low\" type=\"number\" min=\"0\" step=\"any\" value=\"",
      low, "\"> to <input id=\"view-high\" type=\"number\" min=\"0\" step=\"any\" value=\"", high,
      "\"> lx</label>\n<label><input id=\"view-log\" type=\"checkbox\" checked> logarithmic</label>\n"
      "<label><input id=\"view-lines\" type=\"checkbox\"> isolux lines</label>\n"
      "<label><input id=\"view-glass\" type=\"checkbox\" checked> glass</label>\n"
      "<label>Cut <input id=\"view-cut\" type=\"range\" min=\"1\" max=\"200\" value=\"200\"> <span "
      "id=\"view-cut-height\"></span></label>\n"
      "<button type=\"button\" id=\"view-above\">From above</button> <button type=\"button\" "
      "id=\"view-aslant\">Aslant</button>\n</div>\n"
      "<div class=\"stage\"><canvas id=\"view-canvas\" tabindex=\"0\" aria-label=\"3D view of the illuminance on "
      "surfaces\"></canvas>\n"
      "<p id=\"view-status\">The 3D view is being made ...</p>\n"
      "<div id=\"view-legend\"><div id=\"view-colours\"></div><div id=\"view-ticks\"></div></div>\n"
      "<dl id=\"view-probe\" aria-live=\"polite\"></dl></div>\n"
      "<img id=\"view-print\" alt=\"3D view as it was on the screen\">\n</div>\n",
      data.elements, "</section>\n");
  return out;
}

}  // namespace clerestory
