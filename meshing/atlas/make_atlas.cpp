#include "meshing/atlas/make_atlas.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>

#include "meshing/atlas/find_charts.h"
#include "meshing/atlas/fit_texels.h"
#include "meshing/atlas/measure_atlas.h"
#include "meshing/atlas/pack_charts.h"
#include "solver/model/bake_points.h"
#include "solver/model/error.h"
#include "solver/model/parallel.h"

namespace clerestory {
namespace {

constexpr double kMostTexels = double{kLargestAtlas} * kLargestAtlas;

double area_of(const WrittenResult& result) {
  double area = 0;
  for (const auto& [a, b, c] : result.triangles)
    area += length(cross(result.points[b] - result.points[a], result.points[c] - result.points[a])) / 2;
  return area;
}

/// x cut to two digits.
double rounded_down(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 1);
  return std::floor(x / unit + 1e-9) * unit;
}

[[noreturn]] void refuse(const WrittenResult& result, double asked, double area) {
  // Charts as they are cut for some 4 million texels, drawn finer.
  const double coarse = std::min(asked, std::sqrt(4e6 / area));
  const std::vector<AtlasChart> charts = find_charts(result, coarse);
  const auto texels_fit = [&](double texels_per_metre) {
    std::vector<AtlasChart> finer = charts;
    const auto grow = [&](int& texels) {
      texels = static_cast<int>(std::min(1e6, std::ceil((texels - 1) * texels_per_metre / coarse) + 1));
    };
    for (AtlasChart& chart : finer) grow(chart.width), grow(chart.height);
    return pack_charts(finer)[0] > 0;
  };
  double most = std::min(asked * 0.95, std::sqrt(0.95 * kMostTexels / area));
  for (int i = 0; i < 200 && !texels_fit(most); ++i) most *= 0.95;
  std::ostringstream message;
  message << result.file << ": " << asked << " texels per metre need a picture larger than " << kLargestAtlas << " x "
          << kLargestAtlas << " for " << std::llround(area) << " m2; --texels-per-metre " << rounded_down(0.95 * most)
          << " fits.";
  throw InputError(message.str());
}

void set_uv(const WrittenResult& result, LightmapAtlas& atlas) {
  atlas.chart_of.resize(result.triangles.size());
  atlas.uv.resize(result.triangles.size());
  for (std::uint32_t i = 0; i < atlas.charts.size(); ++i) {
    const AtlasChart& chart = atlas.charts[i];
    for (const std::uint32_t t : chart.triangles) {
      atlas.chart_of[t] = i;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [x, y] = chart.texel_of(result.points[result.triangles[t][k]]);
        atlas.uv[t][k] = {static_cast<float>((chart.x + 0.5 + x) / atlas.width),
                          static_cast<float>((chart.y + 0.5 + y) / atlas.height)};
      }
    }
  }
}

/// P x channels of the atlas.
Field values_at_points(const WrittenResult& result) {
  const std::vector<float>& lux = result.of_points.at("illuminance").value;
  const Field shown = shown_at_points(result, glowing_materials(result));
  Field value(result.points.size(), LightmapAtlas::kShown + shown.channels);
  for (std::size_t i = 0; i < value.size(); ++i) {
    value.at(i, LightmapAtlas::kIlluminance) = lux[i];
    for (int k = 0; k < shown.channels; ++k) value.at(i, LightmapAtlas::kShown + k) = shown.at(i, k);
  }
  return value;
}

/// Charts by texels, most first: threads end together.
std::vector<std::size_t> largest_first(const std::vector<AtlasChart>& charts) {
  std::vector<std::size_t> order(charts.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::int64_t{charts[a].width} * charts[a].height > std::int64_t{charts[b].width} * charts[b].height;
  });
  return order;
}

/// What lies between charts: means of what is near, so that smaller copies of the picture do not darken at borders.
void fill_between(int width, int height, std::size_t channels, std::vector<std::uint8_t>& is_known,
                  std::vector<float>& value) {
  if (width < 2 && height < 2) return;
  const int half_width = (width + 1) / 2, half_height = (height + 1) / 2;
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  };
  const auto half_at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(half_width) + static_cast<std::size_t>(x);
  };
  std::vector<std::uint8_t> half_known(static_cast<std::size_t>(half_width) * static_cast<std::size_t>(half_height), 0);
  std::vector<float> half(half_known.size() * channels, 0.f);
  std::size_t unknown = 0;
  for (int y = 0; y < half_height; ++y)
    for (int x = 0; x < half_width; ++x) {
      int count = 0;
      for (int j = 2 * y; j < std::min(height, 2 * y + 2); ++j)
        for (int i = 2 * x; i < std::min(width, 2 * x + 2); ++i)
          if (is_known[at(i, j)]) {
            ++count;
            for (std::size_t c = 0; c < channels; ++c)
              half[half_at(x, y) * channels + c] += value[at(i, j) * channels + c];
          } else {
            ++unknown;
          }
      if (count == 0) continue;
      half_known[half_at(x, y)] = 1;
      for (std::size_t c = 0; c < channels; ++c) half[half_at(x, y) * channels + c] /= static_cast<float>(count);
    }
  if (unknown == 0) return;
  fill_between(half_width, half_height, channels, half_known, half);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (!is_known[at(x, y)])
        for (std::size_t c = 0; c < channels; ++c)
          value[at(x, y) * channels + c] = half[half_at(x / 2, y / 2) * channels + c];
}

/// All texels.
void paint(const WrittenResult& result, const Field& value, const Monitor& monitor, LightmapAtlas& atlas) {
  const auto channels = static_cast<std::size_t>(value.channels);
  const auto texels = static_cast<std::size_t>(atlas.width) * static_cast<std::size_t>(atlas.height);
  atlas.value.assign(texels * channels, 0.f);
  std::vector<std::uint8_t> is_known(texels, 0);
  const std::vector<std::size_t> order = largest_first(atlas.charts);
  parallel_blocks(order.size(), 64, 1, "texels", monitor, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      const AtlasChart& chart = atlas.charts[order[i]];
      const std::vector<float> texel = fit_texels(result, chart, value);
      for (int y = -AtlasChart::kGutter; y < chart.height + AtlasChart::kGutter; ++y)
        for (int x = -AtlasChart::kGutter; x < chart.width + AtlasChart::kGutter; ++x) {
          const auto there = static_cast<std::size_t>(chart.y + y) * static_cast<std::size_t>(atlas.width) +
                             static_cast<std::size_t>(chart.x + x);
          const auto here =
              static_cast<std::size_t>(std::clamp(y, 0, chart.height - 1)) * static_cast<std::size_t>(chart.width) +
              static_cast<std::size_t>(std::clamp(x, 0, chart.width - 1));
          is_known[there] = 1;
          for (std::size_t c = 0; c < channels; ++c) atlas.value[there * channels + c] = texel[here * channels + c];
        }
    }
    return 0;
  });
  fill_between(atlas.width, atlas.height, channels, is_known, atlas.value);
}

}  // namespace

LightmapAtlas make_atlas(const WrittenResult& result, double texels_per_metre, const Monitor& monitor) {
  const double area = area_of(result);
  if (area * texels_per_metre * texels_per_metre > kMostTexels) refuse(result, texels_per_metre, area);
  LightmapAtlas atlas;
  atlas.texels_per_metre = texels_per_metre;
  atlas.charts = find_charts(result, texels_per_metre, monitor);
  if (monitor.should_stop()) return {};
  const Field value = values_at_points(result);
  atlas.channels = value.channels;
  const auto [width, height] = pack_charts(atlas.charts);
  if (width == 0) refuse(result, texels_per_metre, area);
  atlas.width = width, atlas.height = height;
  double used = 0;
  for (const AtlasChart& chart : atlas.charts) used += static_cast<double>(chart.used);
  atlas.used = used / (double{1} * width * height);
  set_uv(result, atlas);
  paint(result, value, monitor, atlas);
  if (monitor.should_stop()) return {};
  atlas.error = measure_atlas(result, value, atlas);
  return atlas;
}

BakedMesh with_atlas(const BakedMesh& mesh, const LightmapAtlas& atlas) {
  BakedMesh split;
  split.triangles = mesh.triangles, split.surface = mesh.surface, split.material = mesh.material;
  // Of each chart's vertices, which are few at a time.
  std::vector<std::uint32_t> from;
  for (const AtlasChart& chart : atlas.charts) {
    std::map<std::uint32_t, std::uint32_t> renamed;
    for (const std::uint32_t t : chart.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t old = mesh.triangles[t][k];
        const auto [vertex, is_new] = renamed.try_emplace(old, static_cast<std::uint32_t>(from.size()));
        if (is_new) from.push_back(old), split.atlas_uv.push_back(atlas.uv[t][k]);
        split.triangles[t][k] = vertex->second;
      }
  }
  split.E = Field(from.size(), mesh.E.channels), split.shown = Field(from.size(), mesh.shown.channels);
  for (std::size_t i = 0; i < from.size(); ++i) {
    split.position.push_back(mesh.position[from[i]]);
    split.normal.push_back(mesh.normal[from[i]]);
    split.illuminance.push_back(mesh.illuminance[from[i]]);
    split.E.set(i, mesh.E[from[i]]);
    split.shown.set(i, mesh.shown[from[i]]);
  }
  return split;
}

}  // namespace clerestory
