#include "io/annual/honeybee_folder.h"

#include <array>
#include <cstdio>
#include <set>

#include <nlohmann/json.hpp>

#include "io/output_folder.h"
#include "io/text.h"
#include "solver/model/annual.h"
#include "solver/model/assert.h"

namespace clerestory {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Letters, digits, '_', '-' and inner dots; the rest becomes '_'.
std::string file_word(const std::string& name) {
  std::string word;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
                       c == '-' || (c == '.' && !word.empty());
    word += plain ? c : '_';
  }
  return word.empty() ? "grid" : word.substr(0, 100);
}

/// By grid, no two alike, also where small letters and capitals are.
std::vector<std::string> ids_of(const std::vector<HoneybeeGrid>& grids) {
  std::vector<std::string> ids;
  std::set<std::string> used;
  for (const HoneybeeGrid& grid : grids) {
    const std::string word = file_word(grid.name);
    std::string id = word;
    for (int k = 2; !used.insert(to_lower(id)).second; ++k) id = text(word, '_', k);
    ids.push_back(id);
  }
  return ids;
}

void write_json(AtomicFile& file, const Json& json) {
  file.write(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

/// All light is told as that of windows whose blinds do not move: it is with blinds as they stand.
constexpr const char* kLightPath = "__static_apertures__";

Json grids_info(const std::vector<HoneybeeGrid>& grids, const std::vector<std::string>& ids) {
  Json info = Json::array();
  for (std::size_t g = 0; g < grids.size(); ++g) {
    info.push_back({{"name", grids[g].name},
                    {"identifier", ids[g]},
                    {"count", grids[g].points},
                    {"group", ""},
                    {"full_id", ids[g]},
                    {"light_path", Json::array({Json::array({kLightPath})})}});
  }
  return info;
}

/// States of windows whose blinds move: none.
Json grid_states(const std::vector<std::string>& ids) {
  Json states = Json::object();
  for (const std::string& id : ids) states[id] = Json::object();
  return states;
}

/// Hours are told by their middle.
std::string sun_up_hours(std::span<const int> hours) {
  std::string lines;
  for (const int hour : hours) lines += text(hour, ".5\n");
  return lines;
}

Json study_info() {
  Json hours = Json::array();
  for (std::size_t h = 0; h < kHoursOfYear; ++h) hours.push_back(static_cast<double>(h) + 0.5);
  return {{"timestep", 1}, {"study_hours", hours}};
}

std::string column(const std::vector<double>& values) {
  std::string lines;
  for (const double value : values) {
    std::array<char, 32> line{};
    std::snprintf(line.data(), line.size(), "%.2f\n", value);
    lines += line.data();
  }
  return lines;
}

struct Metric {
  const char *folder, *extension;
  std::vector<double> HoneybeeMetrics::*values;
};
constexpr Metric kMetrics[] = {{"da", "da", &HoneybeeMetrics::da},
                               {"cda", "cda", &HoneybeeMetrics::cda},
                               {"udi", "udi", &HoneybeeMetrics::udi},
                               {"udi_lower", "udi", &HoneybeeMetrics::udi_lower},
                               {"udi_upper", "udi", &HoneybeeMetrics::udi_upper}};

}  // namespace

HoneybeeFolder::HoneybeeFolder(const fs::path& folder, std::span<const int> hours, std::vector<HoneybeeGrid> grids) {
  const std::vector<std::string> ids = ids_of(grids);
  const Json info = grids_info(grids, ids);
  const fs::path light = folder / kLightPath / "default";
  for (const char* kind : {"total", "direct"}) make_folder(light / kind);
  for (const Metric& metric : kMetrics) {
    const fs::path own = folder / "metrics" / metric.folder;
    make_folder(own);
    write_json(files_.open(own / "grids_info.json"), info);
  }
  files_.open(folder / "sun-up-hours.txt").write(sun_up_hours(hours));
  write_json(files_.open(folder / "study_info.json"), study_info());
  write_json(files_.open(folder / "grid_states.json"), grid_states(ids));
  for (std::size_t g = 0; g < grids.size(); ++g) {
    const std::string file = ids[g] + ".npy";
    total_.emplace_back(files_.open(light / "total" / file), grids[g].points, hours.size());
    direct_.emplace_back(files_.open(light / "direct" / file), grids[g].points, hours.size());
    for (const Metric& metric : kMetrics)
      metrics_.push_back(&files_.open(folder / "metrics" / metric.folder / (ids[g] + "." + metric.extension)));
  }
  write_json(files_.open(folder / "grids_info.json"), info);  // the last to get its name
}

void HoneybeeFolder::add(std::size_t grid, std::span<const float> total, std::span<const float> direct) {
  total_[grid].add(total);
  direct_[grid].add(direct);
}

void HoneybeeFolder::commit(std::span<const HoneybeeMetrics> metrics) {
  CLERESTORY_ASSERT(metrics.size(), ==, total_.size());
  auto file = metrics_.begin();
  for (std::size_t g = 0; g < metrics.size(); ++g) {
    total_[g].end(), direct_[g].end();
    for (const Metric& metric : kMetrics) (*file++)->write(column(metrics[g].*metric.values));
  }
  files_.commit();
}

}  // namespace clerestory
