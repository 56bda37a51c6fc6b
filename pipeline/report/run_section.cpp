#include <algorithm>
#include <cmath>

#include "io/input_file.h"
#include "io/page/html_table.h"
#include "io/text.h"
#include "pipeline/report/page_sections.h"
#include "pipeline/wording.h"

namespace clerestory {
namespace {

constexpr std::size_t kMostRows = 100;

std::string list_of(const std::vector<std::string>& lines, const char* kind) {
  std::string out = text("<ul class=\"", kind, "\">\n");
  for (std::size_t i = 0; i < std::min(lines.size(), kMostRows); ++i) out += "<li>" + xml_text(lines[i]) + "</li>\n";
  if (lines.size() > kMostRows) out += "<li>" + and_more(lines.size() - kMostRows) + "</li>\n";
  return out + "</ul>\n";
}

std::string spectrum_words(const Spectrum& s) {
  const std::string r = rounded(s[0], 2), g = rounded(s[1], 2), b = rounded(s[2], 2);
  return r == g && g == b ? r : r + " / " + g + " / " + b;
}

/// "below 3 %" where it is a bound.
std::string share_words(double share, bool bound) { return (bound ? "below " : "") + percent(share); }

std::string value_words(const Figure& figure) {
  return std::visit(
      [](const auto& value) -> std::string {
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, bool>)
          return value ? "yes" : "no";
        else if constexpr (std::is_same_v<Value, std::string>)
          return value;
        else if constexpr (std::is_same_v<Value, double>)
          return rounded(value, 4);
        else
          return text(value);
      },
      figure.value);
}

std::string spaced(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

std::vector<std::string> error_row(const RunReport::PartError& part) {
  const RunReport::Error& e = part.error;
  const std::string area = part.area > 0 ? area_words(part.area) : std::string();
  if (e.samples == 0) return {part.name, area, lux_words(part.mean_illuminance), "no light found", "", "", "", "0"};
  return {part.name,
          area,
          lux_words(part.mean_illuminance),
          share_words(e.rms_relative, e.bound),
          e.bound ? "" : "+- " + percent(e.confidence),
          percent(e.median_relative),
          percent(e.p95_relative),
          grouped(e.samples)};
}

/// What the error is for whoever reads a figure of the page.
std::string in_plain_words(const RunReport::Error& e, const std::string& where) {
  return text("<p>Half of all points ", where, " are within ", percent(e.median_relative),
              " of the true value, 95 % of them within ", percent(e.p95_relative),
              ". Where this page says 500 lx, the ", "model truly has between ", rounded(500 * (1 - e.median_relative)),
              " and ", rounded(500 * (1 + e.median_relative)), " lx at every second point, and between ",
              rounded(std::max(0.0, 500 * (1 - e.p95_relative))), " and ", rounded(500 * (1 + e.p95_relative)),
              " lx at nineteen of twenty. The root mean square error is ", share_words(e.rms_relative, e.bound),
              " of the mean", e.bound ? std::string() : " (+- " + percent(e.confidence) + ")", ", found at ",
              counted(e.samples, "random point"), ".",
              e.bound ? " It is an upper bound: the error is smaller than what so many points can tell." : "",
              "</p>\n");
}

std::string worst_words(const RunReport::PartError& worst) {
  const RunReport::Error& e = worst.error;
  return text("<p>The room that is farthest off is <strong>", xml_text(worst.name),
              "</strong>: ", share_words(e.rms_relative, e.bound), " rms of its mean of ",
              lux_words(worst.mean_illuminance), " lx", e.bound ? std::string() : " (+- " + percent(e.confidence) + ")",
              "; half of its points are within ", percent(e.median_relative), ", 95 % within ", percent(e.p95_relative),
              ".</p>\n");
}

}  // namespace

std::string luminaire_section(const RunReport& run) {
  if (run.luminaires.empty()) return {};
  HtmlTable table({"<luminaire", "<group", "count", "flux of one lm", "flux of all lm", "light output ratio"});
  std::size_t count = 0;
  double flux = 0;
  for (std::size_t i = 0; i < run.luminaires.size(); ++i) {
    const RunReport::Luminaires& l = run.luminaires[i];
    count += l.count, flux += l.luminous_flux;
    if (i >= kMostRows) continue;
    const std::string name = l.type == "file" ? short_name(l.file) : l.type;
    table.add({name, l.group, grouped(l.count),
               lux_words(l.luminous_flux / static_cast<double>(std::max<std::size_t>(l.count, 1))),
               lux_words(l.luminous_flux), l.lamp_flux > 0 ? percent(l.file_flux / l.lamp_flux) : std::string()});
  }
  if (run.luminaires.size() > kMostRows)
    table.add({and_more(run.luminaires.size() - kMostRows) + " kinds", "", "", "", "", ""}, "rest");
  table.add({"all", "", grouped(count), "", lux_words(flux), ""}, "group");
  return "<section>\n<h2 id=\"luminaires\">Luminaires</h2>\n" + table.html() +
         "<p class=\"soft\">Flux with dimming and maintenance factor included.</p>\n</section>\n";
}

std::string daylight_section(const WrittenResult& result, const RunReport& run,
                             const std::vector<SensorSummary>& sets) {
  const SceneAround& around = result.around;
  if (!run.daylight && !around.daylight_reference && around.sky.empty()) return {};
  std::vector<std::pair<std::string, std::string>> facts;
  if (const auto sky = result.texts.find("settings.sky"); sky != result.texts.end() && !sky->second.empty())
    facts.emplace_back("Sky", sky->second.front());
  if (around.daylight_reference)
    facts.emplace_back("Illuminance on open ground", lux_words(*around.daylight_reference) + " lx");
  if (run.daylight) {
    const Daylight& d = *run.daylight;
    if (!run.time.empty()) facts.emplace_back("At", run.time);
    if (d.weather)
      facts.emplace_back("Weather", text(short_name(d.weather->file), ", month ", d.weather->month, ", day ",
                                         d.weather->day, ", the hour that ends at ", d.weather->hour, ":00"));
    if (d.time) {
      const long minutes = std::lround(d.time->hour * 60);
      facts.emplace_back("Time", text(minutes / 60, minutes % 60 < 10 ? ":0" : ":", minutes % 60));
    }
    facts.emplace_back("Sun", text(rounded(d.sun.elevation_deg), " degrees above the horizon, ",
                                   rounded(d.sun.azimuth_deg), " degrees clockwise from north"));
  }
  std::string out = "<section>\n<h2 id=\"daylight\">Daylight</h2>\n" + html_facts(facts);
  if (around.daylight_reference) {
    HtmlTable table({"<sensors", "mean daylight factor", "median", "points at 2 % or more"});
    for (const SensorSummary& s : sets)
      if (s.daylight_factor)
        table.add({s.name, rounded(s.daylight_factor->mean) + " %", rounded(s.daylight_factor->median) + " %",
                   percent(s.daylight_factor->share)});
    if (!table.empty()) out += table.html();
  } else {
    out += "<p class=\"soft\">Daylight factors are told of an overcast sky without sun.</p>\n";
  }
  return out + "</section>\n";
}

std::string material_section(const WrittenResult& result) {
  const std::vector<double> areas = areas_of_materials(result);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < areas.size(); ++i)
    if (areas[i] > 0) order.push_back(i);
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t i) { return areas[i]; });
  HtmlTable table({"<material", "<kind", "reflectance", "transmittance", "area m2"});
  double rest = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const Material& m = result.materials[order[k]];
    if (k >= kMostRows) {
      rest += areas[order[k]];
      continue;
    }
    const bool passes = m.lets_rays_pass() || m.scatters_through();
    table.add({m.name, std::string(kMaterialKindNames[static_cast<std::size_t>(m.kind)]),
               m.lets_rays_pass() ? std::string("as glass") : spectrum_words(m.reflectance),
               passes ? spectrum_words(m.transmittance) : std::string(), area_words(areas[order[k]])});
  }
  if (order.size() > kMostRows) table.add({and_more(order.size() - kMostRows), "", "", "", area_words(rest)}, "rest");
  return "<section>\n<h2 id=\"materials\">Materials</h2>\n" + table.html() +
         "<p class=\"soft\">Areas of sides that light can reach; of panes, of one side. Where three figures are given "
         "they "
         "are of red, green and blue.</p>\n</section>\n";
}

std::string error_section(const RunReport& run) {
  std::string out = "<section>\n<h2 id=\"error\">How good the figures are</h2>\n";
  if (!run.error && !run.error_sensors) return out + "<p>The error of this result was not measured.</p>\n</section>\n";
  out +=
      "<p>After the solve the illuminance was estimated again at random points by another method, one without "
      "systematic error, and compared. Nothing here is assumed.</p>\n";
  if (run.error_sensors) out += "<h3>At sensors</h3>\n" + in_plain_words(*run.error_sensors, "of the sensors");
  if (run.error) {
    out += "<h3>On surfaces</h3>\n" + in_plain_words(*run.error, "of the surfaces");
    if (run.worst_space) out += worst_words(run.error_spaces[*run.worst_space]);
  }
  HtmlTable table({"<room or sensors", "area m2", "mean lx", "rms", "+-", "half within", "95 % within", "points"});
  std::size_t rows = 0;
  for (const auto* parts : {&run.error_sets, &run.error_spaces})
    for (const RunReport::PartError& part : *parts)
      if (rows++ < kMostRows) table.add(error_row(part));
  if (rows > kMostRows) table.add({and_more(rows - kMostRows), "", "", "", "", "", "", ""}, "rest");
  if (!table.empty()) out += table.html();
  return out +
         "<p class=\"soft\">rms: root mean square difference, of the mean of the room; +-: with 95 % confidence. The "
         "error "
         "is that of the computation alone. How well reflectances, photometric files and the sky of the model stand "
         "for the "
         "building is another question, and often the larger one.</p>\n</section>\n";
}

std::string run_section(const WrittenResult& result, const RunReport& run) {
  std::string out = "<section>\n<h2 id=\"computation\">Computation</h2>\n";
  std::vector<std::pair<std::string, std::string>> facts = {{"Scene", short_name(run.input)}, {"Method", run.method}};
  for (const Figure& setting : run.settings)
    if (setting.name != "method" && setting.name != "threads")
      facts.emplace_back(spaced(setting.name) + (setting.name == "max_element" ? " [m]" : ""), value_words(setting));
  const auto add_count = [&](const char* what, unsigned long long n) {
    if (n > 0) facts.emplace_back(what, grouped(n));
  };
  add_count("Triangles", run.counts.triangles), add_count("Elements", run.counts.elements);
  add_count("Points of the result", result.points.size()), add_count("Sensors", run.counts.sensors);
  add_count("Links", run.counts.links), add_count("Rays", run.counts.rays);
  facts.emplace_back("Ended", run.stop == StopReason::converged ? text("converged, residual ", rounded(run.residual, 2))
                                                                : stop_name(run.stop));
  out += html_facts(facts);
  const EnergyBalance& e = run.energy;
  if (e.emitted > 0)
    out += "<h3>Energy balance</h3>\n" +
           html_facts({{"Emitted, or come in from the sky", rounded(e.emitted, 4) + " W"},
                       {"Absorbed", rounded(e.absorbed, 4) + " W, " + percent(e.absorbed / e.emitted)},
                       {"Left the scene", rounded(e.escaped, 4) + " W, " + percent(e.escaped / e.emitted)},
                       {"Unaccounted for", percent(e.imbalance())}});
  if (!run.warnings.empty()) out += "<h3>Warnings</h3>\n" + list_of(run.warnings, "warning");
  if (!run.left_out.empty())
    out += "<h3>Left out, for the scene did not need it</h3>\n" + list_of(run.left_out, "plain");
  if (!run.not_read.empty()) {
    HtmlTable table({"<in the model, not used", "count", "<first"});
    for (std::size_t i = 0; i < std::min(run.not_read.size(), kMostRows); ++i)
      table.add({run.not_read[i].what, grouped(run.not_read[i].count), run.not_read[i].first});
    out += "<h3>What the model holds and was not used</h3>\n" + table.html();
  }
  return out + "</section>\n";
}

}  // namespace clerestory
