#pragma once
// A texture lightmap: charts of the surfaces of a result, laid out in one picture.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "solver/model/channels.h"
#include "solver/model/vec.h"

namespace clerestory {

/// Triangles of one surface and side, flat or nearly so, and where they are in the picture: `width` x `height` texels
/// from (x, y), whose outermost centres lie on the bounds of the triangles.
struct AtlasChart {
  std::vector<std::uint32_t> triangles;
  std::uint32_t surface = 0;
  Vec3 normal;            ///< unit, of the lit side
  Vec3 origin;            ///< centre of texel (x, y), scene's frame [m]
  Vec3 u, v;              ///< from one texel to the next in x and in y [m]; at right angles; u x v is along the normal
  bool is_planar = true;  ///< all triangles lie in the plane of u and v; else they are projected on it
  int width = 2, height = 2;
  int x = 0, y = 0;
  double area = 0;  ///< of the triangles [m2]
  /// Texels that a lookup reaches, and those beside them.
  std::uint64_t used = 0;

  /// Where p is, in texels from (x, y).
  std::array<double, 2> texel_of(const Vec3& p) const {
    const Vec3 d = p - origin;
    return {std::clamp(dot(d, u) / dot(u, u), 0.0, width - 1.0), std::clamp(dot(d, v) / dot(v, v), 0.0, height - 1.0)};
  }
  static constexpr int kGutter = 1;  ///< texels around the rectangle that repeat its outermost
};

/// How far lookups are from the values that they are made of: |lookup - value| / value, of values below a thousandth of
/// the surface's largest that thousandth instead.
struct AtlasError {
  double share_within_1_percent = 1;   ///< of the area
  double p95 = 0, p99 = 0, worst = 0;  ///< by area; at the worst of all points that were looked at
  std::uint32_t worst_surface = 0;
  Vec3 worst_place;  ///< scene's frame [m]
};

struct LightmapAtlas {
  int width = 0, height = 0;
  double texels_per_metre = 0;
  std::vector<AtlasChart> charts;
  std::vector<std::uint32_t> chart_of;                  ///< N, of each triangle
  std::vector<std::array<std::array<float, 2>, 3>> uv;  ///< N, of its corners, in [0, 1], v down
  static constexpr int kIlluminance = 0, kShown = 1;    ///< channels: [lx]; BakedMesh::shown, one or three [W/m2]
  int channels = 1;
  std::vector<float> value;  ///< width x height x channels, row by row from the top
  double used = 0;           ///< share of the texels that a lookup reaches, or that lie beside such
  AtlasError error;          ///< of the first channel

  std::size_t texels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  float at(std::size_t texel, int channel) const {
    return value[texel * static_cast<std::size_t>(channels) + static_cast<std::size_t>(channel)];
  }
  /// What a viewer finds at (u, v): bilinear between texel centres, clamped to the edge.
  float lookup(float u, float v, int channel) const;
};

}  // namespace clerestory
