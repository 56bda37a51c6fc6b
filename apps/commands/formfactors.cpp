// clerestory formfactors: what part of the light leaving one surface arrives at another.

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>

#include <CLI/CLI.hpp>

#include "apps/commands/commands.h"
#include "apps/finish_report.h"
#include "apps/run.h"
#include "io/atomic_file.h"
#include "io/run_report.h"
#include "io/scene_file/nearest_name.h"
#include "io/write_result.h"
#include "meshing/triangulate_polygon.h"
#include "pipeline/wording.h"
#include "solver/form_factors/surface_form_factors.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

struct Arguments {
  CommonArguments common;
  ReadOptions read;
  std::string input, output;
  std::optional<std::string> by;
  int most_samples = 0;
};

constexpr std::array<std::string_view, 4> kGroupNames{"object", "material", "surface", "patch"};  // as in GroupBy

std::string problem_with_group(const std::string& name) {
  if (std::ranges::find(kGroupNames, name) != kGroupNames.end()) return {};
  return "'" + name + "' is not known; " + suggestion(name, kGroupNames) + ".";
}

GroupBy group_by(const Arguments& arguments) {
  return static_cast<GroupBy>(std::ranges::find(kGroupNames, arguments.by.value_or("object")) - kGroupNames.begin());
}

/// The faces as they were read, as one-sided patches: no repair, no refinement, each face acting on the side it is
/// wound counter-clockwise.
PatchSet faces_as_patches(const Scene& scene) {
  PatchSet patches;
  const PolygonSoup& soup = scene.polygons;
  Vec3 lower, upper;
  bool first = true;
  for (const Vec3& v : soup.vertices) {
    if (!is_finite(v)) continue;
    lower = first ? v : Vec3{std::min(lower.x, v.x), std::min(lower.y, v.y), std::min(lower.z, v.z)};
    upper = first ? v : Vec3{std::max(upper.x, v.x), std::max(upper.y, v.y), std::max(upper.z, v.z)};
    first = false;
  }
  patches.origin = (lower + upper) * 0.5;
  patches.channels = 1;
  patches.materials = scene.materials;
  for (Material& material : patches.materials) material.kind = MaterialKind::diffuse;  // all faces block
  patches.surfaces = scene.surfaces;
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    std::vector<Vec3> polygon;
    for (std::uint32_t c = soup.face_begin[f]; c < soup.face_begin[f + 1]; ++c)
      polygon.push_back(soup.vertices[soup.corner[c]] - patches.origin);
    if (!std::ranges::all_of(polygon, is_finite)) continue;
    PolygonTriangles cut = triangulate_polygon(polygon);
    if (cut.gave_up)
      throw InputError(scene.file + ": face " + std::to_string(f) + " (from 0) with " + std::to_string(polygon.size()) +
                       " corners crosses itself too often; draw it as polygons that do not, or as triangles.");
    polygon.insert(polygon.end(), cut.crossings.begin(), cut.crossings.end());
    const std::size_t start = patches.vertices.size();
    patches.vertices.insert(patches.vertices.end(), polygon.begin(), polygon.end());
    for (const auto& t : cut.triangles) {
      patches.corners.push_back({VertexId{start + t[0]}, VertexId{start + t[1]}, VertexId{start + t[2]}});
      patches.side_material.push_back({soup.material[f], soup.material[f]});
      patches.side_surface.push_back({soup.surface[f], soup.surface[f]});
    }
  }
  std::vector<bool> fronts(2 * patches.triangle_count(), false);
  for (std::size_t t = 0; t < patches.triangle_count(); ++t) fronts[2 * t + kFront] = true;
  make_patches(patches, fronts);
  return patches;
}

/// Shortest text that reads back as the same number.
std::string exact(double value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

/// A name as one CSV cell.
std::string cell(const std::string& name) {
  if (name.find_first_of(",\"\n\r") == std::string::npos) return name;
  std::string quoted = "\"";
  for (const char c : name) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string as_csv(const SurfaceFactors& factors, const PatchGroups& groups) {
  std::string csv = "from,to,F,std_error,visibility\n";
  for (const SurfaceFactor& f : factors.rows)
    csv += cell(groups.name[f.from]) + "," + cell(groups.name[f.to]) + "," + exact(f.F) + "," + exact(f.std_error) +
           "," + exact(f.visibility) + "\n";
  return csv;
}

std::string four_digits(double value) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

/// Pairs whose rays were used up before the standard error was small enough.
void warn_of_errors(const SurfaceFactors& factors, const PatchGroups& groups, Console& console) {
  const SurfaceFactor* worst = nullptr;
  std::size_t missed = 0;
  for (const SurfaceFactor& f : factors.rows) {
    if (f.reached()) continue;
    ++missed;
    if (!worst || f.std_error / f.F > worst->std_error / worst->F) worst = &f;
  }
  if (!worst) return;
  console.warn(counted(missed, "pair") + " of " + counted(factors.rows.size(), "pair") +
               " did not reach a standard error of " + percent(kFactorError) +
               " of F before its rays were used up; the worst, '" + groups.name[worst->from] + "' to '" +
               groups.name[worst->to] + "', is at " + percent(worst->std_error / worst->F) +
               ". std_error says what was reached; more rays: --samples.");
}

ExitCode formfactors_command(const Arguments& arguments, Console& console) {
  check_writable(arguments.output);
  const Scene scene = read_scene(arguments.input, arguments.read);
  console.has_read(scene.files);
  for (const std::string& warning : scene.warnings) console.note(warning);
  const PatchSet patches = faces_as_patches(scene);
  if (patches.patch_count() == 0)
    throw InputError(arguments.input +
                     ": no face has an area, so there are no form factors; check the model's export.");
  const PatchGroups groups = group_patches(patches, group_by(arguments));
  constexpr std::size_t kMostGroups = 3'000;  // nine million rows, of about 100 bytes each in memory
  if (groups.name.size() > kMostGroups)
    throw InputError(arguments.input + ": " + counted(groups.name.size(), "group") + " would make " +
                     std::to_string(groups.name.size() * groups.name.size()) + " rows; at most " +
                     std::to_string(kMostGroups) + " groups are written. Use --by object or --by material.");
  const RayScene rays(patches);
  const SurfaceFactorOptions options{.most_samples = arguments.most_samples, .seed = arguments.common.seed.value_or(1)};
  const SurfaceFactors factors = surface_form_factors(patches, rays, groups, options, console.monitor());
  if (!factors.complete) {
    console.warn("interrupted before the factors were complete; nothing is written.");
    return kInterrupted;
  }
  Outputs outputs;
  outputs.open(arguments.output).write(as_csv(factors, groups));

  console.say(arguments.input + ": " + counted(groups.name.size(), "group") + ", " +
              counted(patches.patch_count(), "triangle") + "; " + std::to_string(factors.pairs_unblocked) +
              " pairs exact, " + std::to_string(factors.pairs_sampled) + " by rays");
  constexpr std::size_t kRowsShown = 40;
  for (std::size_t g = 0; g < groups.name.size() && g < kRowsShown; ++g)
    console.say("row sum " + groups.name[g] + " " + four_digits(factors.row_sum[g]));
  if (groups.name.size() > kRowsShown)
    console.say("row sums of " + std::to_string(groups.name.size() - kRowsShown) + " more groups are not shown");
  console.say("reciprocity error " + four_digits(factors.reciprocity_error));
  warn_of_errors(factors, groups, console);
  RunReport report = new_report(arguments.input);
  report.counts.triangles = patches.triangle_count();
  report.counts.elements = patches.patch_count();
  report.counts.rays = factors.rays;
  finish_report(report, arguments.common, console, outputs);
  console.commit(outputs);
  console.say("results " + arguments.output);
  return kDone;
}

}  // namespace

void add_formfactors_command(CLI::App& program, Task& task) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *program.add_subcommand("formfactors", "form factors between named surfaces, with row sums");
  add_input_options(command, arguments->input, arguments->read);
  command.add_option("-o,--output", arguments->output, "one row per ordered pair: from,to,F,std_error,visibility")
      ->type_name("F.csv")
      ->required();
  require_extension(command, "--output", {".csv"});
  add_checked_word(command, "--by", arguments->by, problem_with_group,
                   "object, material, surface (the faces of an object in one plane) or patch (each triangle) "
                   "(default: object)");
  command
      .add_option(
          "--samples", arguments->most_samples,
          "most rays that count for each pair of triangles with something in between, by 256s (default: 32768 to "
          "16777216, by how many such pairs there are)")
      ->type_name("N")
      ->check(CLI::Range(256, 1 << 24).description(""));
  add_common_options(command, arguments->common);
  command.footer("example: clerestory formfactors data/scenes/parallel_plates.obj -o factors.csv --by object");
  command.callback([arguments, &task] {
    task = [arguments] {
      return run(arguments->common, arguments->input, {{"-o", arguments->output}},
                 [&](Console& console) { return formfactors_command(*arguments, console); });
    };
  });
}

}  // namespace clerestory
