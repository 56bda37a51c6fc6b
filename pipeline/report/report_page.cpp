#include "pipeline/report/report_page.h"

#include <algorithm>
#include <numeric>

#include "io/input_file.h"
#include "io/page/html_table.h"
#include "io/page/plan_data.h"
#include "io/scene_file/nearest_name.h"
#include "io/some_of.h"
#include "io/text.h"
#include "pipeline/report/page_sections.h"
#include "pipeline/wording.h"
#include "solver/model/error.h"
#include "solver/model/inner_rooms.h"

namespace clerestory {
namespace {

/// The browser itself refuses whatever would come from elsewhere.
constexpr const char* kHead = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data: blob:">
)";

std::string project_of(const WrittenResult& result, const RunReport& run) {
  const auto at = result.texts.find("input");
  const std::string input = !run.input.empty()         ? run.input
                            : at != result.texts.end() ? at->second.front()
                                                       : result.file;
  return short_name(input);
}

std::string key_figures(const std::vector<RoomFigures>& rooms, const std::vector<SensorSummary>& sets,
                        const WrittenResult& result, const RunReport& run) {
  std::vector<std::pair<std::string, std::string>> key;
  const std::vector<bool> inner = inner_rooms(result);
  const auto is_inner = [&](const std::string& name) {
    const auto at = std::ranges::find(result.rooms, name);
    return at != result.rooms.end() && inner[static_cast<std::size_t>(at - result.rooms.begin())];
  };
  const auto inside = std::ranges::count_if(rooms, is_inner, &RoomFigures::name);
  if (!result.room.empty()) key.emplace_back("Rooms with light", grouped(static_cast<unsigned long long>(inside)));
  if (!run.luminaires.empty()) {
    std::size_t count = 0;
    double flux = 0;
    for (const RunReport::Luminaires& l : run.luminaires) count += l.count, flux += l.luminous_flux;
    key.emplace_back("Luminaires", grouped(count));
    key.emplace_back("Luminous flux", lux_words(flux) + " lm");
  }
  if (result.around.daylight_reference)
    key.emplace_back("Daylight on open ground", lux_words(*result.around.daylight_reference) + " lx");
  constexpr std::size_t kFew = 3;  // sets that are told one by one
  if (sets.size() <= kFew)
    for (std::size_t i = 0; i < sets.size(); ++i) {
      key.emplace_back("Mean, " + sets[i].name, lux_words(sets[i].mean) + " lx");
      if (i == 0) key.emplace_back("Uniformity U0, " + sets[i].name, ratio_words(sets[i].uniformity));
    }
  const auto held = std::ranges::count_if(sets, [](const SensorSummary& s) { return s.threshold.has_value(); });
  const auto met =
      std::ranges::count_if(sets, [](const SensorSummary& s) { return s.threshold && s.mean >= s.threshold->lux; });
  if (sets.size() > kFew && held > 0) key.emplace_back("Sensors whose mean meets the target", text(met, " of ", held));
  // Of rooms that people use; the error is told of all others further down.
  const RunReport::PartError* worst_room = nullptr;
  for (const RunReport::PartError& space : run.error_spaces)
    if ((result.room.empty() || is_inner(space.name)) && space.error.samples > 0 &&
        (!worst_room || space.error.rms_relative > worst_room->error.rms_relative))
      worst_room = &space;
  if (!worst_room && run.worst_space) worst_room = &run.error_spaces[*run.worst_space];
  if (worst_room) {
    const RunReport::PartError& worst = *worst_room;
    key.emplace_back("Measured error (rms), worst room",
                     (worst.error.bound ? "below " : "") + percent(worst.error.rms_relative));
  }
  std::string out = "<dl class=\"key\">\n";
  for (const auto& [what, value] : key)
    out += "<div><dt>" + xml_text(what) + "</dt><dd>" + xml_text(value) + "</dd></div>\n";
  return out + "</dl>\n";
}

/// What clerestory mix made of the layers; nothing where they are as they were solved.
std::string mixed_words(std::vector<ShownLayer> layers) {
  std::erase_if(layers, [](const ShownLayer& layer) { return layer.factor == 1; });
  if (layers.empty()) return {};
  return "<p>This light was mixed. Of what was solved it has " +
         some_of(layers, layers.size(),
                 [](const ShownLayer& layer) { return xml_text(layer.name) + " at " + percent(layer.factor); }) +
         ".</p>\n";
}

/// Links to the sections that there are: "<h2 id=\"view\">3D view</h2>".
std::string contents_of(const std::string& body) {
  constexpr std::string_view kBegin = "<h2 id=\"";
  std::string out = "<nav>\n";
  for (std::size_t at = 0; (at = body.find(kBegin, at)) != body.npos;) {
    at += kBegin.size();
    const std::size_t end = body.find('"', at), close = body.find("</h2>", end);
    out += "<a href=\"#" + body.substr(at, end - at) + "\">" + body.substr(end + 2, close - end - 2) + "</a>\n";
  }
  return out + "</nav>\n";
}

}  // namespace

void require_known_sets(const ReportTargets& targets, const WrittenResult& result) {
  std::vector<std::string_view> known;
  for (const MeasuredSensors& sensors : result.around.sensors) known.push_back(sensors.set.name);
  for (const auto& [name, lux] : targets.of_set) {
    if (std::ranges::find(known, name) != known.end()) continue;
    if (known.empty())
      throw InputError(text(result.file, ": --target ", name, "=", lux,
                            ": the result has no sensors; give the scene \"sensors\" and solve it again."));
    const std::string near = suggestion(name, known);
    throw InputError(
        text(result.file, ": --target: there are no sensors '", name, "'; ", near, near.ends_with('?') ? "" : "."));
  }
}

std::string report_page(const WrittenResult& result, const RunReport& run, const PageFiles& files,
                        const ReportTargets& targets) {
  require_known_sets(targets, result);
  const std::vector<RoomFigures> rooms = figures_by_room(result);
  const std::vector<SensorSummary> sets = summaries_of(result, targets);
  const std::string project = project_of(result, run);

  std::size_t plans = 0;
  std::string body = view_section(result, files);
  body += sets.empty() ? floor_section(result, plans) : sensor_section(result, sets, plans);
  body += room_section(result, rooms, run);
  body += luminaire_section(run) + daylight_section(result, run, sets) + material_section(result) + error_section(run) +
          run_section(result, run);

  std::string page =
      text(kHead, "<title>Lighting report: ", xml_text(project), "</title>\n<style>\n", files.style,
           "</style>\n</head>\n<body>\n<header>\n<h1>", xml_text(project),
           "</h1>\n<p class=\"soft\">Lighting report, computed by Clerestory ", xml_text(run.version), "</p>\n",
           contents_of(body), "</header>\n", key_figures(rooms, sets, result, run), mixed_words(result.around.layers));
  std::vector<std::string> names;
  for (const ShownLayer& layer : result.around.layers) names.push_back(layer.name);
  if (!names.empty() && !files.viewer.empty()) page += layer_sliders(names);
  page += body;
  page += text("<footer>\n<p>Illuminance is in lux (lm/m2), luminous flux in lumen, lengths in metres. Figures of ",
               "rooms and surfaces are of their sides that light can reach, means by area.</p>\n");
  if (!files.viewer.empty()) {
    page += "<details class=\"screen\"><summary>The 3D view is drawn by three.js; its licence</summary>\n<pre>" +
            xml_text(files.viewer_licence) + "</pre></details>\n";
    page += "</footer>\n<script>" + files.viewer + "</script>\n";
  } else {
    page += "</footer>\n";
  }
  return page + "</body>\n</html>\n";
}

}  // namespace clerestory
