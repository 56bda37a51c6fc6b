#include "io/chart/draw.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "io/chart/dot_matrix.h"

namespace clerestory {
namespace {

/// How far (x, y) lies inside of a stroke [pixel].
double inside_line(const Chart::Line& l, double x, double y) {
  const double dx = l.x2 - l.x1, dy = l.y2 - l.y1, length2 = dx * dx + dy * dy;
  const double along = ((x - l.x1) * dx + (y - l.y1) * dy) / length2;
  const double t = length2 > 0 ? std::clamp(along, 0.0, 1.0) : 0.0;
  return l.width / 2 - std::hypot(x - l.x1 - t * dx, y - l.y1 - t * dy);
}

/// Calls covered(x, y, share) for the pixels of a rectangle that `inside` tells to be covered.
template <class Inside, class Covered>
void over(const Pixels& pixels, double left, double top, double right, double bottom, const Inside& inside,
          const Covered& covered) {
  const auto clip = [](double v, int most) { return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(most))); };
  for (int y = clip(top, pixels.height); y < clip(bottom + 1, pixels.height); ++y)
    for (int x = clip(left, pixels.width); x < clip(right + 1, pixels.width); ++x) {
      const double share = std::clamp(inside(x + 0.5, y + 0.5) + 0.5, 0.0, 1.0);
      if (share > 0) covered(x, y, share);
    }
}

template <class Covered>
void over_line(const Pixels& pixels, const Chart::Line& l, const Covered& covered) {
  const double reach = l.width / 2 + 1;
  const auto [left, right] = std::minmax(l.x1, l.x2);
  const auto [top, bottom] = std::minmax(l.y1, l.y2);
  over(
      pixels, left - reach, top - reach, right + reach, bottom + reach,
      [&](double x, double y) { return inside_line(l, x, y); }, covered);
}

void draw(const Chart::Line& l, Pixels& onto) {
  over_line(onto, l, [&](int x, int y, double share) { ink_pixel(onto.at(x, y), l.ink, share); });
}

void draw(const Chart::Disc& d, Pixels& onto) {
  over(
      onto, d.x - d.radius - 1, d.y - d.radius - 1, d.x + d.radius + 1, d.y + d.radius + 1,
      [&](double x, double y) { return d.radius - std::hypot(x - d.x, y - d.y); },
      [&](int x, int y, double share) { ink_pixel(onto.at(x, y), d.ink, share); });
}

void draw(const Chart::Words& w, Pixels& onto) {
  const double dot = w.size / kLineOfDots, all = width_of_words(w.text, w.size);
  double x = w.x - (w.anchor == Chart::Anchor::start ? 0 : w.anchor == Chart::Anchor::middle ? all / 2 : all);
  for (const char c : w.text) {
    for (const DotStroke& s : strokes_of(c))
      draw(Chart::Line{x + (s.x1 + 0.5) * dot, w.y + (s.y1 - kDotsAboveBase + 0.5) * dot, x + (s.x2 + 0.5) * dot,
                       w.y + (s.y2 - kDotsAboveBase + 0.5) * dot, 0.9 * dot, w.ink},
           onto);
    x += kDotsToNext * dot;
  }
}

}  // namespace

void ink_pixel(std::uint8_t* pixel, const Ink& ink, double share) {
  const std::uint8_t of_ink[3] = {ink.r, ink.g, ink.b};
  for (int k = 0; k < 3; ++k)
    pixel[k] = static_cast<std::uint8_t>(std::lround(pixel[k] + share * (of_ink[k] - pixel[k])));
}

void draw(const Chart& chart, Pixels& onto) {
  for (const auto& shape : chart.shapes) std::visit([&](const auto& s) { draw(s, onto); }, shape);
}

void draw_stroke(const std::vector<Corner>& corners, double width, const Ink& ink, Pixels& onto) {
  std::unordered_map<std::size_t, double> cover;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k)
    over_line(
        onto, {corners[k].x, corners[k].y, corners[k + 1].x, corners[k + 1].y, width, ink},
        [&](int x, int y, double share) {
          double& most =
              cover[static_cast<std::size_t>(y) * static_cast<std::size_t>(onto.width) + static_cast<std::size_t>(x)];
          most = std::max(most, share);
        });
  for (const auto& [pixel, share] : cover) ink_pixel(&onto.rgb[3 * pixel], ink, share);
}

double width_of_words(const std::string& words, double size) {
  return size / kLineOfDots * kDotsToNext * static_cast<double>(words.size());
}

}  // namespace clerestory
