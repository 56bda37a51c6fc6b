#include "io/bake/atlas_files.h"

#include <nlohmann/json.hpp>

#include "io/picture/encode.h"
#include "solver/model/exposure.h"

namespace clerestory {
namespace {

using Json = nlohmann::ordered_json;

Json triple(const Vec3& p) { return {p.x, p.y, p.z}; }

}  // namespace

void write_atlas_exr(AtomicFile& file, const LightmapAtlas& atlas) {
  std::vector<float> lux(atlas.texels());
  for (std::size_t i = 0; i < lux.size(); ++i) lux[i] = atlas.at(i, LightmapAtlas::kIlluminance);
  file.write(exr_bytes(atlas.width, atlas.height, {"Y"}, lux));
}

void write_atlas_png(AtomicFile& file, const LightmapAtlas& atlas, double exposure) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(3 * atlas.texels());
  const int colours = atlas.channels - LightmapAtlas::kShown;
  for (std::size_t i = 0; i < atlas.texels(); ++i) {
    std::uint8_t byte = 0;
    for (int k = 0; k < 3; ++k) {
      if (k < colours) byte = srgb_byte(exposure * double{atlas.at(i, LightmapAtlas::kShown + k)});
      rgb.push_back(byte);
    }
  }
  file.write(png_bytes(atlas.width, atlas.height, rgb));
}

void write_atlas_json(AtomicFile& file, const LightmapAtlas& atlas, const WrittenResult& result) {
  const AtlasError& error = atlas.error;
  Json charts = Json::array();
  for (const AtlasChart& c : atlas.charts)
    charts.push_back({{"surface", result.surfaces[c.surface]},
                      {"normal", triple(c.normal)},
                      {"planar", c.is_planar},
                      {"rectangle", {c.x, c.y, c.width, c.height}},
                      {"origin", triple(c.origin)},
                      {"u", triple(c.u)},
                      {"v", triple(c.v)},
                      {"area", c.area}});
  const Json json = {{"width", atlas.width},
                     {"height", atlas.height},
                     {"texels_per_metre", atlas.texels_per_metre},
                     {"gutter", AtlasChart::kGutter},
                     {"used", atlas.used},
                     {"error",
                      {{"share_within_1_percent", error.share_within_1_percent},
                       {"p95", error.p95},
                       {"p99", error.p99},
                       {"worst", error.worst},
                       {"worst_surface", result.surfaces.empty() ? "" : result.surfaces[error.worst_surface]},
                       {"worst_place", triple(error.worst_place)}}},
                     {"charts", std::move(charts)}};
  file.write(json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace clerestory
