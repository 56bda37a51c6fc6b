#include <algorithm>
#include <cmath>
#include <vector>

#include "io/chart/chart.h"
#include "io/chart/dot_matrix.h"
#include "io/picture/encode.h"

namespace clerestory {
namespace {

/// Shapes are drawn by their distance: a pixel is covered as far as its middle is inside of the edge.
class Pixels {
 public:
  Pixels(int width, int height)
      : width_(width),
        height_(height),
        rgb_(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 255) {}

  void draw(const Chart::Line& l) {
    const double reach = l.width / 2 + 1, dx = l.x2 - l.x1, dy = l.y2 - l.y1, length2 = dx * dx + dy * dy;
    const auto [left, right] = std::minmax(l.x1, l.x2);
    const auto [top, bottom] = std::minmax(l.y1, l.y2);
    over(left - reach, top - reach, right + reach, bottom + reach, l.ink, [&](double x, double y) {
      const double along = ((x - l.x1) * dx + (y - l.y1) * dy) / length2;
      const double t = length2 > 0 ? std::clamp(along, 0.0, 1.0) : 0.0;
      return l.width / 2 - std::hypot(x - l.x1 - t * dx, y - l.y1 - t * dy);
    });
  }
  void draw(const Chart::Disc& d) {
    over(d.x - d.radius - 1, d.y - d.radius - 1, d.x + d.radius + 1, d.y + d.radius + 1, d.ink,
         [&](double x, double y) { return d.radius - std::hypot(x - d.x, y - d.y); });
  }
  void draw(const Chart::Words& w) {
    const double dot = w.size / kLineOfDots, all = dot * kDotsToNext * static_cast<double>(w.text.size());
    double x = w.x - (w.anchor == Chart::Anchor::start ? 0 : w.anchor == Chart::Anchor::middle ? all / 2 : all);
    for (const char c : w.text) {
      for (const DotStroke& s : strokes_of(c))
        draw(Chart::Line{x + (s.x1 + 0.5) * dot, w.y + (s.y1 - kDotsAboveBase + 0.5) * dot, x + (s.x2 + 0.5) * dot,
                         w.y + (s.y2 - kDotsAboveBase + 0.5) * dot, 0.9 * dot, w.ink});
      x += kDotsToNext * dot;
    }
  }
  const std::vector<std::uint8_t>& rgb() const { return rgb_; }

 private:
  template <class Inside>
  void over(double left, double top, double right, double bottom, const Ink& ink, const Inside& inside) {
    const auto clip = [](double v, int most) {
      return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(most)));
    };
    for (int y = clip(top, height_); y < clip(bottom + 1, height_); ++y)
      for (int x = clip(left, width_); x < clip(right + 1, width_); ++x) {
        const double share = std::clamp(inside(x + 0.5, y + 0.5) + 0.5, 0.0, 1.0);
        if (!(share > 0)) continue;
        std::uint8_t* pixel =
            &rgb_[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x))];
        const std::uint8_t of_ink[3] = {ink.r, ink.g, ink.b};
        for (int k = 0; k < 3; ++k)
          pixel[k] = static_cast<std::uint8_t>(std::lround(pixel[k] + share * (of_ink[k] - pixel[k])));
      }
  }
  int width_, height_;
  std::vector<std::uint8_t> rgb_;
};

}  // namespace

std::string png_of(const Chart& chart) {
  Pixels pixels(chart.width, chart.height);
  for (const auto& shape : chart.shapes) std::visit([&](const auto& s) { pixels.draw(s); }, shape);
  return png_bytes(chart.width, chart.height, pixels.rgb());
}

}  // namespace clerestory
