#pragma once
// Numbers of a view -> pixels of a picture.

#include <string>
#include <vector>

#include "io/chart/draw.h"
#include "io/picture/value_scale.h"
#include "solver/model/view_image.h"

namespace clerestory {

/// As a screen shows it: sRGB of exposure x pi x radiance; `background` where nothing is seen, in linear values of a
/// screen.
Pixels true_colours(const ViewImage& radiance, double exposure, double background);

/// viridis by the scale; white where nothing is seen. Needs: one channel.
Pixels false_colours(const ViewImage& image, const ValueScale& scale);
Ink false_colour(double value, const ValueScale& scale);
/// Black or white, whichever is told from the ink.
Ink contrast_to(const Ink& ink);

/// The same picture with its scale to the right of it, which makes it wider.
Pixels with_legend(const Pixels& picture, const ValueScale& scale, const std::string& quantity,
                   const std::string& unit);

/// A line of equal value as a picture shows it: its visible parts.
struct LineOnPicture {
  double level = 0;
  std::vector<std::vector<Corner>> parts;
};
/// Lines, and a number at each that has room for it. scale: of the picture's false colours, null for true ones.
void draw_lines(const std::vector<LineOnPicture>& lines, const ValueScale* scale, Pixels& onto);

}  // namespace clerestory
