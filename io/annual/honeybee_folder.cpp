#include "io/annual/honeybee_folder.h"

#include <array>
#include <cstdio>
#include <set>

#include <nlohmann/json.hpp>

#include "io/annual/output_folder.h"
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

void write_json(const fs::path& file, const Json& json) {
  write_file(file, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

Json grids_info(const std::vector<HoneybeeGrid>& grids, const std::vector<std::string>& ids) {
  Json info = Json::array();
  for (std::size_t g = 0; g < grids.size(); ++g) {
    Json paths = Json::array();
    for (const HoneybeeLightPath& path : grids[g].light_paths) paths.push_back(Json::array({path.name}));
    info.push_back({{"name", grids[g].name},
                    {"identifier", ids[g]},
                    {"count", grids[g].points},
                    {"group", ""},
                    {"full_id", ids[g]},
                    {"light_path", paths}});
  }
  return info;
}

/// States of the windows with blinds.
Json grid_states(const std::vector<HoneybeeGrid>& grids, const std::vector<std::string>& ids) {
  Json states = Json::object();
  for (std::size_t g = 0; g < grids.size(); ++g) {
    states[ids[g]] = Json::object();
    for (const HoneybeeLightPath& path : grids[g].light_paths)
      if (path.name != kStaticApertures.name) states[ids[g]][path.name] = path.states;
  }
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

}  // namespace

HoneybeeFolder::HoneybeeFolder(const fs::path& folder, std::span<const int> hours, std::vector<HoneybeeGrid> grids)
    : folder_(folder), hours_(hours.size()), grids_(std::move(grids)), ids_(ids_of(grids_)) {
  make_folder(folder_);
  std::error_code none;
  fs::remove(folder_ / "grids_info.json", none);
  write_file(folder_ / "sun-up-hours.txt", sun_up_hours(hours));
  write_json(folder_ / "study_info.json", study_info());
  write_json(folder_ / "grid_states.json", grid_states(grids_, ids_));
}

void HoneybeeFolder::add(std::size_t grid, std::size_t light_path, std::size_t state, std::span<const float> total,
                         std::span<const float> direct) {
  CLERESTORY_ASSERT(total.size(), ==, direct.size());
  const HoneybeeLightPath& path = grids_[grid].light_paths[light_path];
  std::unique_ptr<Rows>& rows = open_[{grid, light_path, state}];
  const std::size_t points = grids_[grid].points;
  if (!rows) {
    const fs::path own = folder_ / path.name / path.states[state];
    for (const char* kind : {"total", "direct"}) make_folder(own / kind);
    rows = std::make_unique<Rows>(own, ids_[grid] + ".npy", points, hours_);
  }
  rows->total.add(total);
  rows->direct.add(direct);
  rows->missing -= total.size() / hours_;
  if (rows->missing > 0) return;
  rows->total.end(), rows->direct.end();
  rows->total_file.commit();
  rows->direct_file.commit();
  open_.erase({grid, light_path, state});
}

void HoneybeeFolder::commit(std::span<const HoneybeeMetrics> metrics) {
  CLERESTORY_ASSERT(open_.size(), ==, std::size_t{0});
  CLERESTORY_ASSERT(metrics.size(), ==, grids_.size());
  struct Metric {
    const char *folder, *extension;
    std::vector<double> HoneybeeMetrics::*values;
  };
  constexpr Metric kMetrics[] = {{"da", "da", &HoneybeeMetrics::da},
                                 {"cda", "cda", &HoneybeeMetrics::cda},
                                 {"udi", "udi", &HoneybeeMetrics::udi},
                                 {"udi_lower", "udi", &HoneybeeMetrics::udi_lower},
                                 {"udi_upper", "udi", &HoneybeeMetrics::udi_upper}};
  const Json info = grids_info(grids_, ids_);
  for (const Metric& metric : kMetrics) {
    const fs::path own = folder_ / "metrics" / metric.folder;
    make_folder(own);
    for (std::size_t g = 0; g < grids_.size(); ++g)
      write_file(own / (ids_[g] + "." + metric.extension), column(metrics[g].*metric.values));
    write_json(own / "grids_info.json", info);
  }
  write_json(folder_ / "grids_info.json", info);
}

}  // namespace clerestory
