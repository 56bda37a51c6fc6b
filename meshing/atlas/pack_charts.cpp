#include "meshing/atlas/pack_charts.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#define STB_RECT_PACK_IMPLEMENTATION
#define STBRP_STATIC
#include <stb/stb_rect_pack.h>

#include "solver/model/parallel.h"

namespace clerestory {
namespace {

/// One way to lay the rectangles out.
struct Layout {
  int width = 0, height = 0;
  std::vector<stbrp_rect> rects;
  std::int64_t area() const { return std::int64_t{width} * height; }
};

int multiple_of_4(int x) { return (x + 3) / 4 * 4; }

Layout packed(const std::vector<stbrp_rect>& rects, int width, int heuristic) {
  Layout layout{.width = width, .rects = rects};
  std::vector<stbrp_node> nodes(static_cast<std::size_t>(width));
  stbrp_context context;
  stbrp_init_target(&context, width, kLargestAtlas, nodes.data(), width);
  stbrp_setup_heuristic(&context, heuristic);
  if (!stbrp_pack_rects(&context, layout.rects.data(), static_cast<int>(layout.rects.size()))) return {};
  for (const stbrp_rect& r : layout.rects) layout.height = std::max(layout.height, r.y + r.h);
  layout.height = multiple_of_4(layout.height);
  return layout;
}

/// Rectangles with their gutters, all lying or all standing.
std::vector<stbrp_rect> rectangles(const std::vector<AtlasChart>& charts, bool standing) {
  std::vector<stbrp_rect> rects;
  for (std::size_t i = 0; i < charts.size(); ++i) {
    stbrp_rect r{};
    r.id = static_cast<int>(i);
    r.w = charts[i].width + 2 * AtlasChart::kGutter, r.h = charts[i].height + 2 * AtlasChart::kGutter;
    if ((r.w < r.h) != standing && r.w != r.h) std::swap(r.w, r.h);
    rects.push_back(r);
  }
  return rects;
}

}  // namespace

std::array<int, 2> pack_charts(std::vector<AtlasChart>& charts) {
  if (charts.empty()) return {4, 4};
  double area = 0;
  for (const AtlasChart& c : charts) area += (c.width + 2.0) * (c.height + 2.0);
  if (area > double{kLargestAtlas} * kLargestAtlas) return {0, 0};

  struct Try {
    int width, heuristic;
    bool standing;
  };
  std::vector<Try> tries;
  // A layout takes as long as charts times the steps of its skyline: the more there are, the fewer are tried.
  const bool are_many = charts.size() > 30'000;
  const int widths = charts.size() < 300 ? 96 : charts.size() < 3000 ? 32 : are_many ? 3 : 12;
  const std::array<std::vector<stbrp_rect>, 2> rects{rectangles(charts, false), rectangles(charts, true)};
  for (const bool standing : {false, true}) {
    int widest = 4;
    for (const stbrp_rect& r : rects[standing]) widest = std::max(widest, r.w);
    for (int i = 0; i < widths; ++i) {
      const double around = std::sqrt(area / 0.95) * (0.7 + 0.8 * i / widths);
      const int width = multiple_of_4(std::max(widest, static_cast<int>(around)));
      if (width > kLargestAtlas) continue;
      tries.push_back({width, STBRP_HEURISTIC_Skyline_BL_sortHeight, standing});
      if (!are_many) tries.push_back({width, STBRP_HEURISTIC_Skyline_BF_sortHeight, standing});
    }
  }
  std::vector<std::int64_t> size(tries.size(), 0);
  const auto layout_of = [&](const Try& t) { return packed(rects[t.standing], t.width, t.heuristic); };
  parallel_for(tries.size(), 1, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) size[i] = layout_of(tries[i]).area();
  });
  std::size_t best = 0;
  for (std::size_t i = 1; i < tries.size(); ++i)
    if (size[i] > 0 && (size[best] == 0 || size[i] < size[best])) best = i;
  if (size[best] == 0) return {0, 0};

  const Layout layout = layout_of(tries[best]);
  for (const stbrp_rect& r : layout.rects) {
    AtlasChart& c = charts[static_cast<std::size_t>(r.id)];
    if (r.w != c.width + 2 * AtlasChart::kGutter) {  // turned, and not mirrored: x goes where y went, y against x
      c.origin += c.u * (c.width - 1.0);
      const Vec3 u = c.u;
      c.u = c.v, c.v = -u;
      std::swap(c.width, c.height);
    }
    c.x = r.x + AtlasChart::kGutter, c.y = r.y + AtlasChart::kGutter;
  }
  return {layout.width, layout.height};
}

}  // namespace clerestory
