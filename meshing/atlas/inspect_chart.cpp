#include "meshing/atlas/inspect_chart.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "meshing/atlas/plane_on_texels.h"
#include "solver/model/disjoint_sets.h"

namespace clerestory {
namespace {

using Triangles = std::vector<std::uint32_t>;
using Pair = std::array<std::uint32_t, 2>;

constexpr double kSameLight = 0.01;  // relative; a texel for two lights that differ by less is half of that off

struct Mean {
  Spectrum sum;
  double count = 0;
  void add(const Spectrum& x) { sum += x, count += 1; }
  bool differs_from(const Mean& other) const {
    const Spectrum a = sum / count, b = other.sum / other.count;
    bool differs = false;
    for (int k = 0; k < kMaxChannels; ++k)
      differs = differs || std::abs(a[k] - b[k]) > kSameLight * std::max(std::abs(a[k]), std::abs(b[k]));
    return differs;
  }
};

/// Irradiance of the triangle's plane at a texel.
Spectrum light_at(const WrittenResult& result, std::uint32_t t, const std::array<Texel, 3>& texels,
                  const Texel& texel) {
  const WrittenArray& E = result.of_points.at("irradiance");
  const auto& [a, b, c] = result.triangles[t];
  const auto n = static_cast<std::size_t>(E.components);
  Spectrum light;
  for (std::size_t k = 0; k < n; ++k)
    light[static_cast<int>(k)] =
        plane_of(texels, {E.value[a * n + k], E.value[b * n + k], E.value[c * n + k]}).beyond(texel[0], texel[1]);
  return light;
}

/// Of triangles (places in the chart's list) that one texel is reached from: pairs that do not hang together there
/// and have other light.
void note_strangers(const WrittenResult& result, const TrianglesAcross& across, const AtlasChart& chart,
                    const std::vector<std::array<Texel, 3>>& texels, const Texel& texel, Triangles& here,
                    std::vector<Pair>& pairs) {
  std::sort(here.begin(), here.end());
  here.erase(std::unique(here.begin(), here.end()), here.end());
  if (here.size() < 2) return;
  DisjointSets sets(here.size());
  for (std::size_t i = 0; i < here.size(); ++i)
    for (const std::uint32_t t : across[chart.triangles[here[i]]]) {
      if (t == kNoTriangle) continue;
      const auto place = std::lower_bound(chart.triangles.begin(), chart.triangles.end(), t) - chart.triangles.begin();
      const auto found = std::lower_bound(here.begin(), here.end(), static_cast<std::uint32_t>(place));
      if (found != here.end() && *found == place) sets.join(i, static_cast<std::size_t>(found - here.begin()));
    }
  bool are_together = true;
  for (std::size_t i = 1; i < here.size(); ++i) are_together = are_together && sets.find(i) == sets.find(0);
  if (are_together) return;
  std::vector<Mean> mean(here.size());
  for (std::size_t i = 0; i < here.size(); ++i)
    mean[sets.find(i)].add(light_at(result, chart.triangles[here[i]], texels[here[i]], texel));
  for (std::size_t i = 1; i < here.size(); ++i)
    if (sets.find(i) != sets.find(0) && mean[sets.find(i)].differs_from(mean[sets.find(0)]))
      pairs.push_back({here[0], here[i]});
}

/// Triangles of which both have the middle of a cell inside.
void note_overlaps(const std::vector<std::array<Texel, 3>>& texels, int columns, int rows, std::vector<Pair>& pairs) {
  std::vector<std::uint32_t> owner(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), kNoTriangle);
  for (std::uint32_t i = 0; i < texels.size(); ++i) {
    const auto& t = texels[i];
    const auto [low, high] = std::minmax({t[0][1], t[1][1], t[2][1]});
    for (int y = std::max(0, static_cast<int>(low - 0.5)); y < rows && y + 0.5 < high; ++y) {
      const auto [left, right] = x_range(t, y + 0.5, y + 0.5);
      if (!(left <= right)) continue;
      for (int x = std::max(0, static_cast<int>(left - 0.5)); x < columns && x + 0.5 < right - 1e-4; ++x) {
        if (x + 0.5 <= left + 1e-4) continue;
        std::uint32_t& first =
            owner[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x)];
        if (first == kNoTriangle)
          first = i;
        else if (first != i)
          pairs.push_back({first, i});
      }
    }
  }
}

}  // namespace

Inspection inspect_chart(const WrittenResult& result, const TrianglesAcross& across, const AtlasChart& chart,
                         const std::vector<std::array<Texel, 3>>& texels) {
  const int columns = chart.width - 1, rows = chart.height - 1;
  const auto n_cells = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  const auto cell = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x);
  };
  Inspection found;

  std::vector<std::uint8_t> is_rim(n_cells, 0);
  for (std::size_t i = 0; i < texels.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      if (across[chart.triangles[i]][k] != kNoTriangle) continue;
      const Texel &a = texels[i][k], &b = texels[i][(k + 1) % 3];
      for_rows_of_cells({a, b, b}, columns, rows, [&](int y, int first, int last) {
        for (int x = first; x <= last; ++x) is_rim[cell(x, y)] = 1;
      });
    }
  // A texel of such a cell is reached from the four around it: those are where somebody else may be.
  std::vector<std::uint32_t> list_of(n_cells, kNoTriangle);
  std::uint32_t lists = 0;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      bool near = false;
      for (int j = std::max(0, y - 1); j <= std::min(rows - 1, y + 1); ++j)
        for (int i = std::max(0, x - 1); i <= std::min(columns - 1, x + 1); ++i) near = near || is_rim[cell(i, j)];
      if (near) list_of[cell(x, y)] = lists++;
    }
  std::vector<std::uint8_t> touched(n_cells, 0);
  std::vector<std::uint32_t> start(lists + 1, 0), entry;
  const auto for_entries = [&](const auto& visit) {
    for (std::uint32_t i = 0; i < texels.size(); ++i)
      for_rows_of_cells(texels[i], columns, rows, [&](int y, int first, int last) {
        for (int x = first; x <= last; ++x) {
          touched[cell(x, y)] = 1;
          if (list_of[cell(x, y)] != kNoTriangle) visit(list_of[cell(x, y)], i);
        }
      });
  };
  for_entries([&](std::uint32_t list, std::uint32_t) { ++start[list + 1]; });
  std::partial_sum(start.begin(), start.end(), start.begin());
  entry.resize(start.back());
  std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
  for_entries([&](std::uint32_t list, std::uint32_t i) { entry[next[list]++] = i; });

  Triangles here;
  for (int y = 0; y < chart.height; ++y)
    for (int x = 0; x < chart.width; ++x) {
      here.clear();
      bool near = false;
      for (int j = std::max(0, y - 1); j <= std::min(rows - 1, y); ++j)
        for (int i = std::max(0, x - 1); i <= std::min(columns - 1, x); ++i) {
          if (!is_rim[cell(i, j)]) continue;
          near = true;
        }
      if (!near) continue;
      for (int j = std::max(0, y - 1); j <= std::min(rows - 1, y); ++j)
        for (int i = std::max(0, x - 1); i <= std::min(columns - 1, x); ++i) {
          const std::uint32_t list = list_of[cell(i, j)];
          here.insert(here.end(), entry.begin() + start[list], entry.begin() + start[list + 1]);
        }
      note_strangers(result, across, chart, texels, {1.0 * x, 1.0 * y}, here, found.to_part);
    }
  note_overlaps(texels, columns, rows, found.to_part);
  std::sort(found.to_part.begin(), found.to_part.end());
  found.to_part.erase(std::unique(found.to_part.begin(), found.to_part.end()), found.to_part.end());

  // A cell's four texels and those around them.
  std::vector<std::uint8_t> used(static_cast<std::size_t>(chart.width + 2) * static_cast<std::size_t>(chart.height + 2),
                                 0);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x)
      if (touched[cell(x, y)])
        for (int j = 0; j < 4; ++j)
          std::fill_n(used.begin() + static_cast<std::ptrdiff_t>(y + j) * (chart.width + 2) + x, 4, std::uint8_t{1});
  found.used = static_cast<std::uint64_t>(std::count(used.begin(), used.end(), 1));
  return found;
}

}  // namespace clerestory
