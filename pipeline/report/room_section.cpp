#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "io/page/html_table.h"
#include "io/text.h"
#include "pipeline/report/page_sections.h"
#include "pipeline/wording.h"
#include "solver/model/patch_set.h"

namespace clerestory {
namespace {

constexpr std::size_t kMostRooms = 60, kMostSurfacesOfRoom = 8, kMostRows = 400;

std::vector<std::string> row_of(const std::string& name, const LitFigures& lit) {
  return {name, area_words(lit.area), lux_words(lit.mean), lux_words(lit.lowest), lux_words(lit.highest)};
}

std::string name_of(const std::string& name) { return name.empty() ? "(without a name)" : name; }

}  // namespace

std::string lux_words(double lux) {
  if (lux > 0 && lux < 0.005) return "< 0.01";
  return lux >= 1000 && lux < 1e15 ? grouped(static_cast<unsigned long long>(std::llround(lux))) : rounded(lux);
}

std::string ratio_words(double ratio) {
  const long hundredths = std::lround(100 * ratio);
  return text(hundredths / 100, hundredths % 100 < 10 ? ".0" : ".", hundredths % 100);
}

std::string area_words(double square_metres) {
  return square_metres >= 1000 ? lux_words(square_metres) : rounded(square_metres);
}

std::string and_more(std::size_t n) { return "and " + grouped(n) + " more"; }

std::string room_section(const WrittenResult& result, const std::vector<RoomFigures>& rooms, const RunReport& run) {
  std::vector<std::size_t> by_area(rooms.size());
  std::iota(by_area.begin(), by_area.end(), std::size_t{0});
  std::ranges::stable_sort(by_area, std::greater(), [&](std::size_t i) { return rooms[i].lit.area; });
  const std::size_t shown = std::min(rooms.size(), kMostRooms);
  std::vector<std::size_t> in_order(by_area.begin(), by_area.begin() + static_cast<std::ptrdiff_t>(shown));
  // The outdoors last: it is there in every daylit scene, and nobody asks for it first.
  std::ranges::sort(in_order, {}, [&](std::size_t i) { return std::pair(rooms[i].name == kOutdoors, i); });

  HtmlTable table({"<room, surface", "area m2", "mean lx", "min lx", "max lx"});
  std::size_t rows = 0;
  for (const std::size_t i : in_order) {
    const RoomFigures& room = rooms[i];
    table.add(row_of(name_of(room.name), room.lit), "group");
    const std::size_t most =
        std::min({room.surfaces.size(), kMostSurfacesOfRoom, kMostRows - std::min(rows, kMostRows)});
    for (std::size_t k = 0; k < most; ++k)
      table.add(row_of(name_of(result.surfaces[room.surfaces[k].surface]), room.surfaces[k].lit));
    rows += most;
    LitFigures rest;
    for (std::size_t k = most; k < room.surfaces.size(); ++k) rest.add(room.surfaces[k].lit);
    if (most < room.surfaces.size()) table.add(row_of(and_more(room.surfaces.size() - most), rest), "rest");
  }
  if (shown < rooms.size()) {
    LitFigures rest;
    for (std::size_t k = shown; k < rooms.size(); ++k) rest.add(rooms[by_area[k]].lit);
    table.add(row_of(and_more(rooms.size() - shown) + " rooms", rest), "rest");
  }
  std::string out = "<section>\n<h2 id=\"rooms\">Rooms and surfaces</h2>\n";
  if (!run.spaces.empty()) {
    HtmlTable spaces({"<room", "<long name", "floor m2", "height m", "volume m3"});
    const auto number = [](double x) { return x > 0 ? area_words(x) : std::string(); };
    for (std::size_t i = 0; i < std::min(run.spaces.size(), kMostRooms); ++i) {
      const RunReport::Space& s = run.spaces[i];
      spaces.add({s.name, s.long_name, number(s.area), number(s.height), number(s.volume)});
    }
    if (run.spaces.size() > kMostRooms)
      spaces.add({and_more(run.spaces.size() - kMostRooms) + " rooms", "", "", "", ""}, "rest");
    out += "<h3>Rooms as the model names them</h3>\n" + spaces.html() + "<h3>Illuminance</h3>\n";
  }
  return out + table.html() + "</section>\n";
}

}  // namespace clerestory
