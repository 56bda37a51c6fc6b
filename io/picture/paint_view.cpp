#include "io/picture/paint_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/picture/colour_map.h"
#include "io/text.h"
#include "solver/model/exposure.h"
#include "solver/model/parallel.h"

namespace clerestory {
namespace {

constexpr std::size_t kPixelsAtOnce = 1 << 14;

/// Height of a line of words that is read easily on a picture of that height [pixel].
double size_of_words(int height) { return std::clamp(height / 42.0, 13.0, 48.0); }

Ink ink_of(const std::array<double, 3>& rgb) {
  const auto byte = [](double v) { return static_cast<std::uint8_t>(std::lround(255 * v)); };
  return {byte(rgb[0]), byte(rgb[1]), byte(rgb[2])};
}

/// 1024 steps are closer than two inks.
class Inks {
 public:
  Inks() {
    for (std::size_t i = 0; i <= kSteps; ++i) ink_[i] = ink_of(viridis(static_cast<double>(i) / kSteps));
  }
  const Ink& operator()(double t) const { return ink_[static_cast<std::size_t>(std::lround(t * kSteps))]; }

 private:
  static constexpr std::size_t kSteps = 1024;
  std::array<Ink, kSteps + 1> ink_;
};

struct Rectangle {
  double left, top, right, bottom;
  bool touches(const Rectangle& b) const {
    return left < b.right && b.left < right && top < b.bottom && b.top < bottom;
  }
};

void fill(const Rectangle& r, const Ink& ink, Pixels& onto) {
  for (int y = std::max(0, static_cast<int>(std::lround(r.top)));
       y < std::min(onto.height, static_cast<int>(std::lround(r.bottom))); ++y)
    for (int x = std::max(0, static_cast<int>(std::lround(r.left)));
         x < std::min(onto.width, static_cast<int>(std::lround(r.right))); ++x)
      ink_pixel(onto.at(x, y), ink, 1);
}

double length_of(const std::vector<Corner>& part) {
  double sum = 0;
  for (std::size_t k = 0; k + 1 < part.size(); ++k)
    sum += std::hypot(part[k + 1].x - part[k].x, part[k + 1].y - part[k].y);
  return sum;
}

Corner place_along(const std::vector<Corner>& part, double along) {
  for (std::size_t k = 0; k + 1 < part.size(); ++k) {
    const double step = std::hypot(part[k + 1].x - part[k].x, part[k + 1].y - part[k].y);
    if (along <= step && step > 0) {
      const double t = along / step;
      return {part[k].x + t * (part[k + 1].x - part[k].x), part[k].y + t * (part[k + 1].y - part[k].y)};
    }
    along -= step;
  }
  return part.back();
}

}  // namespace

Pixels true_colours(const ViewImage& radiance, double exposure, double background) {
  Pixels picture(radiance.width, radiance.height, 0);
  const double scale = exposure * std::numbers::pi;
  // A table of the screen's curve, fine enough that no byte is off by one but at its edge.
  constexpr std::size_t kSteps = 1 << 15;
  std::vector<std::uint8_t> byte(kSteps + 1);
  for (std::size_t i = 0; i <= kSteps; ++i) byte[i] = srgb_byte(static_cast<double>(i) / kSteps);
  const auto n = static_cast<std::size_t>(radiance.channels);
  parallel_for(radiance.pixels(), kPixelsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const double linear = scale * double{radiance.value[i * n + (n == 3 ? k : 0)]} +
                              background * std::max(0.0, 1 - double{radiance.seen[i]});
        picture.rgb[3 * i + k] = byte[static_cast<std::size_t>(std::clamp(linear, 0.0, 1.0) * kSteps + 0.5)];
      }
  });
  return picture;
}

Ink false_colour(double value, const ValueScale& scale) {
  return ink_of(viridis(place_in_range(value, scale.low, scale.high, scale.by_logarithm)));
}

Ink contrast_to(const Ink& ink) {
  const double light = 0.3 * ink.r + 0.59 * ink.g + 0.11 * ink.b;
  return light > 120 ? Ink{0, 0, 0} : Ink{255, 255, 255};
}

Pixels false_colours(const ViewImage& image, const ValueScale& scale) {
  Pixels picture(image.width, image.height, 255);
  const Inks inks;
  parallel_for(image.pixels(), kPixelsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!(image.seen[i] > 0)) continue;
      const double seen = double{image.seen[i]}, mean = double{image.value[i]} / seen;
      ink_pixel(&picture.rgb[3 * i], inks(place_in_range(mean, scale.low, scale.high, scale.by_logarithm)),
                std::min(seen, 1.0));
    }
  });
  return picture;
}

Pixels with_legend(const Pixels& picture, const ValueScale& scale, const std::string& quantity,
                   const std::string& unit) {
  const double size = size_of_words(picture.height);
  const std::vector<double> ticks = ticks_of(scale, std::clamp(static_cast<int>(picture.height / (2.2 * size)), 2, 10));
  double widest = std::max(width_of_words(quantity, size), width_of_words(unit, size));
  for (const double v : ticks) widest = std::max(widest, 2 * size + width_of_words(text(v), size));
  const double margin = size;
  Pixels both(picture.width + static_cast<int>(std::ceil(widest + 2 * margin)), picture.height, 255);
  for (int y = 0; y < picture.height; ++y)
    std::copy_n(&picture.rgb[3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width)],
                3 * picture.width, both.at(0, y));

  constexpr Ink kBlack{0, 0, 0};
  const double left = picture.width + margin, top = 4 * size, bottom = std::max(picture.height - 1.5 * size, top + 2);
  Chart words{both.width, both.height, {}};
  words.shapes.push_back(Chart::Words{left, 1.4 * size, size, Chart::Anchor::start, quantity, kBlack});
  words.shapes.push_back(Chart::Words{left, 2.7 * size, size, Chart::Anchor::start, unit, kBlack});
  const auto place = [&](double v) {
    return bottom - (bottom - top) * place_in_range(v, scale.low, scale.high, scale.by_logarithm);
  };
  for (int y = static_cast<int>(top); y < static_cast<int>(bottom); ++y) {
    const Ink ink = ink_of(viridis((bottom - y - 0.5) / (bottom - top)));
    fill({left, 1.0 * y, left + size, y + 1.0}, ink, both);
  }
  for (const double v : ticks) {
    const double y = std::clamp(place(v), top + 0.5, bottom - 0.5);
    words.shapes.push_back(Chart::Line{left + size, y, left + 1.4 * size, y, std::max(1.0, size / 16), kBlack});
    words.shapes.push_back(
        Chart::Words{left + 1.7 * size, y + 0.35 * size, size, Chart::Anchor::start, text(v), kBlack});
  }
  draw(words, both);
  return both;
}

void draw_lines(const std::vector<LineOnPicture>& lines, const ValueScale* scale, Pixels& onto) {
  const double size = 0.9 * size_of_words(onto.height), width = std::max(1.2, onto.height / 700.0);
  constexpr Ink kBlack{0, 0, 0};
  const auto under = [&](const LineOnPicture& line) { return scale ? false_colour(line.level, *scale) : kBlack; };
  for (const LineOnPicture& line : lines)
    for (const auto& part : line.parts) {
      if (!scale) draw_stroke(part, 2.2 * width, kBlack, onto);
      draw_stroke(part, width, contrast_to(under(line)), onto);
    }
  // Longest parts first, each with a label in its middle, long ones with more; none over another.
  struct Place {
    double length;
    const LineOnPicture* line;
    const std::vector<Corner>* part;
  };
  std::vector<Place> places;
  for (const LineOnPicture& line : lines)
    for (const auto& part : line.parts) places.push_back({length_of(part), &line, &part});
  std::ranges::stable_sort(places, std::greater{}, &Place::length);
  std::vector<Rectangle> taken;
  Chart words{onto.width, onto.height, {}};
  for (const Place& place : places) {
    const std::string label = text(place.line->level);
    const double across = width_of_words(label, size) + 0.4 * size, between = std::max(onto.height * 0.8, 4 * across);
    if (place.length < 2.5 * across) continue;
    const int count = std::max(1, static_cast<int>(place.length / between));
    for (int i = 0; i < count; ++i)
      // Beside the middle where that is taken.
      for (const double shift : {0.5, 0.35, 0.65, 0.2, 0.8}) {
        const Corner at = place_along(*place.part, place.length * (i + shift) / count);
        const Rectangle box{at.x - across / 2, at.y - 0.55 * size, at.x + across / 2, at.y + 0.55 * size};
        if (box.left < 1 || box.top < 1 || box.right > onto.width - 1 || box.bottom > onto.height - 1) continue;
        if (std::ranges::any_of(taken, [&](const Rectangle& r) { return r.touches(box); })) continue;
        taken.push_back({box.left - size, box.top - 0.5 * size, box.right + size, box.bottom + 0.5 * size});
        fill(box, under(*place.line), onto);
        words.shapes.push_back(Chart::Words{at.x + 0.05 * size, at.y + 0.35 * size, size, Chart::Anchor::middle, label,
                                            contrast_to(scale ? under(*place.line) : kBlack)});
        break;
      }
  }
  draw(words, onto);
}

}  // namespace clerestory
