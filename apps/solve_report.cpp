#include "apps/solve_report.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "apps/table_lines.h"
#include "io/text.h"
#include "pipeline/collect_around.h"
#include "pipeline/wording.h"
#include "solver/evaluate/sensor_summary.h"
#include "solver/lights/luminaire.h"
#include "solver/methods/form_factor_matrix.h"
#include "solver/model/units.h"
#include "solver/run/memory_estimate.h"

namespace clerestory {
namespace {

RunReport::Error figures_of(const ErrorFigures& e) {
  return {e.rms_relative, e.median_relative, e.p95_relative, e.samples, e.confidence, e.bound};
}

std::vector<RunReport::PartError> parts_of(const std::optional<MeasuredError>& e) {
  std::vector<RunReport::PartError> parts;
  if (!e) return parts;
  for (const ErrorOfPart& p : e->parts) parts.push_back({p.name, p.area, p.mean_illuminance, figures_of(p.figures)});
  return parts;
}

std::vector<std::string> what_was_left_out(const Scene& scene, const Solved& s) {
  std::vector<std::string> out;
  if (s.patches.channels == 1) out.push_back("colour: everything is grey, one channel is solved");
  if (!scene.lights.sky && scene.lights.suns.empty()) out.push_back("sky and sun: the scene has none");
  if (scene.lights.sky && s.openings == 0) out.push_back("openings: the sky looks into no room");
  if (scene.lights.luminaires.empty()) out.push_back("luminaires: the scene has none");
  constexpr const char* kPlural[] = {"", "glass", "diffusers", "mirrors",
                                     "glossy surfaces"};  // in the order of MaterialKind
  static_assert(std::size(kPlural) == std::size(kMaterialKindNames));
  for (std::size_t kind = 1; kind < std::size(kPlural); ++kind)
    if (std::ranges::none_of(s.patches.materials,
                             [&](const Material& m) { return static_cast<std::size_t>(m.kind) == kind; }))
      out.push_back(kPlural[kind] + std::string(": the scene has none"));
  out.insert(out.end(), scene.left_out.begin(), scene.left_out.end());
  if (s.lit_sides.dark_sides) out.push_back(counted(s.lit_sides.dark_sides, "side") + " that no light can reach");
  if (s.lit_sides.luminaire_interiors)
    out.push_back(counted(s.lit_sides.luminaire_interiors, "emitting side") +
                  " that shine on nothing but their own luminaire");
  return out;
}

/// What a law is about, for people.
std::string in_words(Law law) {
  switch (law) {
    case Law::reciprocity:
      return "surfaces see as much of each other";
    case Law::row_sums:
      return "what leaves arrives or is lost";
    case Law::no_negative_light:
      return "no light below zero";
    case Law::radiosity:
      return "sent = emitted + reflected";
    case Law::energy:
      return "no light lost or made";
  }
  return {};
}

std::string remarks(const SensorSummary& s) {
  std::string text;
  if (s.threshold) text += percent(s.threshold->share) + " at " + rounded(s.threshold->lux) + " lx or more";
  if (const auto& d = s.daylight_factor)
    text += (text.empty() ? "" : "; ") + ("daylight factor " + rounded(d->mean)) + " % (median " + rounded(d->median) +
            " %), " + percent(d->share) + " at 2 % or more";
  return text;
}

std::size_t predicted(const RunReport::Counts& c, const Solved& s) {
  const std::size_t sides = 2 * c.triangles - c.dark_sides;
  const bool has_matrix = s.solution.method == "gauss-seidel" || s.solution.method == "jacobi";
  return (has_matrix ? form_factor_bytes(c.elements) : 0) +
         predicted_memory({s.repairs.input_triangles, c.triangles, sides, c.elements, c.points, c.links,
                           s.layers.layers.size() * static_cast<std::size_t>(s.patches.channels)});
}

}  // namespace

std::string error_line(const MeasuredError& e) {
  const ErrorOfPart* worst = e.parts.size() > 1 ? e.worst() : nullptr;
  const std::string where =
      ", measured at " + counted(e.samples, "point") + (e.reference.empty() ? "" : " by " + e.reference) +
      (worst ? "; worst in '" + quotable(worst->name, 40) + "': " + (worst->figures.bound ? "below " : "") +
                   percent(worst->figures.rms_relative) +
                   (worst->figures.bound ? "" : " (+- " + percent(worst->figures.confidence) + ")") + " rms of " +
                   rounded(worst->mean_illuminance) + " lx"
             : "");
  if (e.bound) return "below " + percent(e.rms_relative) + " rms" + where;
  return percent(e.rms_relative) + " rms (+- " + percent(e.confidence) + "), 95 % of points within " +
         percent(e.p95_relative) + where;
}

std::vector<RunReport::Luminaires> luminaires_by_file(const LightSpec& lights) {
  std::vector<RunReport::Luminaires> rows;
  std::map<std::tuple<std::string, const PhotometricWeb*, std::string>, std::size_t> row_of;
  const auto add = [&](const char* type, const PhotometricWeb* web, const std::string& group, const Spectrum& power) {
    const auto [at, is_new] = row_of.try_emplace({type, web, group}, rows.size());
    if (is_new) {
      rows.emplace_back();
      rows.back().type = type;
      rows.back().group = group;
      if (web) {
        rows.back().file = web->name;
        rows.back().file_flux = web->flux;
        rows.back().declared_flux = web->declared_flux;
        rows.back().lamp_flux = web->lamp_flux;
      }
    }
    ++rows[at->second].count;
    rows[at->second].luminous_flux += photometric(power);
  };
  for (const Luminaire& luminaire : lights.luminaires) {
    const auto* file = std::get_if<WebLuminaire>(&luminaire.kind);
    add(kLuminaireKindNames[luminaire.kind.index()].data(), file ? file->web.get() : nullptr, luminaire.group,
        power(luminaire));
  }
  return rows;
}

std::vector<std::string> sensor_table(const std::vector<SensorSummary>& sensors) {
  std::vector<std::vector<std::string>> rows = {{"lux at sensors", "points", "mean", "min", "max", "median", "U0"}};
  for (const SensorSummary& s : sensors) {
    const bool is_plain = s.kind == SensorKind::planar;
    const auto kind = std::string(kSensorKindNames[static_cast<std::size_t>(s.kind)]);
    rows.push_back({"  " + quotable(s.name, 40) + (is_plain ? "" : " (" + kind + ")"), grouped(s.points),
                    rounded(s.mean), rounded(s.min), rounded(s.max), rounded(s.median), rounded(s.uniformity, 2)});
  }
  std::vector<std::string> lines = table_lines(rows);
  for (std::size_t k = 0; k < sensors.size(); ++k)
    if (const std::string note = remarks(sensors[k]); !note.empty()) lines[k + 1] += "  " + note;
  return lines;
}

std::string layer_line(const ShownLayer& layer) {
  return "'" + quotable(layer.name, 40) + "' " + rounded(layer.luminous_flux(), 4) + " lm, " +
         rounded(layer.energy.emitted, 4) + " W emitted, " + rounded(layer.energy.absorbed, 4) + " W absorbed, " +
         rounded(layer.energy.escaped, 4) + " W escaped";
}

std::string law_line(const LawCheck& check, const std::string& method) {
  const std::string name = in_words(check.law) + ": ";
  if (!check.not_checked.empty()) return name + "not checked for " + method + ", " + check.not_checked;
  const auto unresolved = std::ranges::count_if(check.rooms, [](const LawInRoom& room) { return !room.resolved; });
  const std::string but = unresolved > 0 ? "; " + counted(static_cast<unsigned long long>(unresolved), "room") +
                                               " too small or too dark to tell"
                                         : "";
  const LawInRoom* worst = check.worst();
  if (!worst) return name + "no room has light to tell by" + but;
  return name + (check.holds() ? "holds" : "BROKEN") + ", off by " + percent(worst->worst) + " at worst, in '" +
         quotable(worst->room, 40) + "'; " + percent(worst->bound) + " may be" + but;
}

void fill_report(RunReport& r, const Scene& scene, const Solved& s) {
  r.method = s.solution.method;
  r.seconds = s.seconds;
  r.counts.triangles = s.repairs.triangles;
  r.counts.elements = s.patches.patch_count();
  r.counts.dark_sides = s.lit_sides.dark_sides;
  r.counts.clusters = s.solution.clusters;
  r.counts.openings = s.openings;
  r.counts.links = s.solution.links;
  r.counts.points = s.lightmap.position.size();
  r.counts.sensors = s.sensor_E.size();
  r.counts.rays = s.solution.rays;
  r.predicted_memory_bytes = predicted(r.counts, s);
  r.iterations = s.solution.iterations;
  r.residual = s.solution.residual;
  r.energy = s.solution.energy;
  r.stop = s.solution.stop;
  r.log = s.solution.log;
  r.repairs = s.repairs;
  if (s.error) r.error = figures_of(*s.error), r.error->reference = s.error->reference;
  if (s.error_sensors)
    r.error_sensors = figures_of(*s.error_sensors), r.error_sensors->reference = s.error_sensors->reference;
  r.error_spaces = parts_of(s.error);
  r.error_sets = parts_of(s.error_sensors);
  if (const ErrorOfPart* worst = s.error ? s.error->worst() : nullptr)
    r.worst_space = static_cast<std::size_t>(worst - s.error->parts.data());
  r.laws = s.laws;
  r.daylight = scene.daylight;
  r.luminaires = luminaires_by_file(scene.lights);
  r.layers = shown_layers(s);
  if (s.sensor_E.size() > 0) r.sensors = summaries_of(scene.sensors, s.sensor_E, daylight_reference(scene.lights));
  r.spaces = figures_of(scene.spaces);
  r.not_read = scene.not_read;
  r.left_out = what_was_left_out(scene, s);
}

void say_summary(const RunReport& r, const Solved& s, Console& console) {
  const auto& t = r.seconds;
  const Field& E = s.solution.E;
  double flux = 0, largest = 0;
  for (std::size_t i = 0; i < E.size(); ++i) {
    flux += photometric(E[i]) * s.patches.area[i];
    largest = std::max(largest, photometric(E[i]));
  }
  console.say(r.input + ": " + counted(r.counts.elements, "element") + " on " +
              counted(r.counts.triangles, "triangle") + ", " + std::to_string(s.patches.channels) +
              (s.patches.channels == 1 ? " channel" : " channels") + ", method " + r.method);
  console.say("  light   mean illuminance " + rounded(flux / s.patches.total_area()) + " lx, largest " +
              rounded(largest) + " lx");
  console.say("  energy  emitted " + rounded(r.energy.emitted, 4) + " W, absorbed " + rounded(r.energy.absorbed, 4) +
              " W, escaped " + rounded(r.energy.escaped, 4) + " W, imbalance " + percent(r.energy.imbalance()));
  console.say("  error   " + (s.error ? error_line(*s.error) : std::string("not measured")));
  const std::string but =
      s.buried_sensors > 0 ? "; not of " + counted(s.buried_sensors, "sensor") + " inside a solid" : "";
  if (s.error_sensors)
    console.say("  sensors " + error_line(*s.error_sensors) + but);
  else if (std::ranges::all_of(s.sensor_E.value, [](double value) { return value == 0; }) && !r.sensors.empty())
    console.say("  sensors no light arrives at them, so there is no error to tell");
  for (const LawCheck& check : s.laws) console.say("  law     " + law_line(check, r.method));
  for (const ShownLayer& layer : r.layers) console.say("  layer   " + layer_line(layer));
  if (!r.sensors.empty())
    for (const std::string& line : sensor_table(r.sensors)) console.say("  " + line);
  console.say("  time    " + duration(t.total) + " (read " + duration(t.read) + ", mesh " + duration(t.mesh) +
              ", solve " + duration(t.build + t.direct + t.refine + t.gather) + ", show " + duration(t.reconstruct) +
              ", measure " + duration(t.measure) + "), memory " + bytes(r.peak_memory_bytes));
}

}  // namespace clerestory
