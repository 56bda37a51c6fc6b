#include "io/page/plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "io/page/css_colour.h"
#include "io/picture/colour_map.h"
#include "io/picture/iso_lines.h"
#include "io/picture/round_numbers.h"
#include "io/text.h"

namespace clerestory {
namespace {

constexpr double kWidest = 620, kHighest = 520;         // of the plan itself [px]
constexpr double kLegend = 92, kBelow = 34, kEdge = 1;  // beside and below it [px]
constexpr int kColours = 64;
constexpr std::size_t kMostCells = 60'000, kMostDots = 20'000;

std::string number(double x, int digits = 1) {
  char out[32];
  std::snprintf(out, sizeof out, "%.*f", digits, x);
  std::string s = out;
  if (s.find('.') != s.npos) {
    while (s.ends_with('0')) s.pop_back();
    if (s.ends_with('.')) s.pop_back();
  }
  return s == "-0" ? "0" : s;
}

std::string hex(int colour) { return css_colour(colour / (kColours - 1.0)); }

/// Metres to pixels, y down.
struct Scale {
  PlanPoint low, high;
  double px = 1;  ///< a metre

  explicit Scale(const Plan& plan) : low(plan.low), high(plan.high) {
    const double width = std::max(high.x - low.x, 1e-9), height = std::max(high.y - low.y, 1e-9);
    px = std::min(kWidest / width, kHighest / height);
  }
  double x(double metres) const { return kEdge + (metres - low.x) * px; }
  double y(double metres) const { return kEdge + (high.y - metres) * px; }
  std::string operator()(const PlanPoint& p) const { return number(x(p.x)) + " " + number(y(p.y)); }
  double width() const { return (high.x - low.x) * px; }
  double height() const { return (high.y - low.y) * px; }
};

int colour_of(const Plan& plan, double lux) {
  return static_cast<int>(
      std::lround((kColours - 1) * place_in_range(lux, plan.lowest, plan.highest, plan.by_logarithm)));
}

/// One path a colour, a little over its edges, for between two that only meet paper shows through. Cells of one colour
/// that lie side by side are one rectangle. Of more cells than a picture shows, blocks are drawn in the colour of their
/// middle.
std::string cells_of(const Plan& plan, const Scale& scale) {
  const Lattice& lattice = *plan.lattice;
  const std::size_t step =
      1 + static_cast<std::size_t>(std::sqrt(static_cast<double>(lattice.columns * lattice.rows) / kMostCells));
  const auto colour = [&](std::size_t row, std::size_t column) {
    const std::size_t r = std::min(row + step / 2, lattice.rows - 1),
                      c = std::min(column + step / 2, lattice.columns - 1);
    const double lux = lattice.value[r * lattice.columns + c];
    return std::isnan(lux) ? -1 : colour_of(plan, lux);
  };
  std::map<int, std::string> paths;
  for (std::size_t row = 0; row < lattice.rows; row += step)
    for (std::size_t begin = 0, end = 0; begin < lattice.columns; begin = end) {
      const int here = colour(row, begin);
      for (end = begin + step; end < lattice.columns && colour(row, end) == here;) end += step;
      if (here < 0) continue;
      const auto n = std::to_string(std::min(end, lattice.columns) - begin);
      const auto m = std::to_string(std::min(row + step, lattice.rows) - row);
      paths[here] += "M" + std::to_string(begin) + " " + std::to_string(row) + "h" + n + "v" + m + "h-" + n + "z";
    }
  const PlanPoint corner = lattice.place(-0.5, -0.5);
  std::string out =
      text("<g class=\"cells\" stroke-width=\".06\" transform=\"matrix(", number(lattice.u.x * scale.px, 4), " ",
           number(-lattice.u.y * scale.px, 4), " ", number(lattice.v.x * scale.px, 4), " ",
           number(-lattice.v.y * scale.px, 4), " ", scale(corner), ")\">\n");
  for (const auto& [shade, path] : paths)
    out += "<path fill=\"" + hex(shade) + "\" stroke=\"" + hex(shade) + "\" d=\"" + path + "\"/>\n";
  return out + "</g>\n";
}

/// Points nearer to one another than can be seen are one.
std::string path_of(const PlanLine& line, const Scale& scale) {
  constexpr double kSeen = 0.3;  // [px]
  std::string d = "M" + scale(line.front());
  PlanPoint last = line.front();
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (i + 1 < line.size() && std::hypot(line[i].x - last.x, line[i].y - last.y) * scale.px < kSeen) continue;
    d += "L" + scale(line[i]);
    last = line[i];
  }
  return d;
}

std::string paths_of(const std::vector<PlanLine>& lines, const char* kind, const Scale& scale) {
  if (lines.empty()) return {};
  std::string d;
  for (const PlanLine& line : lines) d += path_of(line, scale);
  return text("<path class=\"", kind, "\" d=\"", d, "\"/>\n");
}

std::string lux_label(double lux) {
  if (lux == 0) return "0";
  const double size = std::abs(lux);
  return number(lux, size >= 100 ? 0 : size >= 1 ? 1 : 4);
}

/// Where the label of a line is farthest from those that are placed, its middle preferred; nothing where all is taken.
std::optional<PlanPoint> label_place(const PlanLine& line, const std::vector<PlanPoint>& placed, const Scale& scale) {
  constexpr double kFree = 40, kLeast = 18;  // [px]
  constexpr std::size_t kTries[] = {8, 6, 10, 4, 12, 2, 14};
  std::optional<PlanPoint> best;
  double most = kLeast;
  for (const std::size_t sixteenths : kTries) {
    const PlanPoint& at = line[(line.size() - 1) * sixteenths / 16];
    const PlanPoint px{scale.x(at.x), scale.y(at.y)};
    double free = kFree;
    for (const PlanPoint& other : placed) free = std::min(free, std::hypot(px.x - other.x, px.y - other.y));
    if (free > most) best = px, most = free;
  }
  return best;
}

/// The lines, and their labels, which lie over all else.
std::pair<std::string, std::string> isolux_of(const Plan& plan, const Scale& scale) {
  std::map<double, std::string> paths;
  std::map<double, const PlanLine*> longest;
  for (const Plan::Isolux& line : plan.isolux) {
    paths[line.lux] += path_of(line.line, scale);
    const PlanLine*& best = longest[line.lux];
    if (!best || line.line.size() > best->size()) best = &line.line;
  }
  std::string out, words;
  std::vector<PlanPoint> placed;
  for (const auto& [lux, path] : paths) {
    if (plan.target == lux) out += "<path class=\"isolux casing\" d=\"" + path + "\"/>\n";
    out += text("<path class=\"isolux", plan.target == lux ? " target" : "", "\" d=\"", path, "\"/>\n");
    const auto at = label_place(*longest[lux], placed, scale);
    if (!at) continue;
    placed.push_back(*at);
    words += text("<text class=\"isolux\" x=\"", number(at->x), "\" y=\"", number(at->y + 4), "\">", lux_label(lux),
                  "</text>\n");
  }
  return {out, words};
}

std::string marks_of(const Plan& plan, const Scale& scale) {
  std::string out;
  for (const Plan::Mark& mark : plan.luminaires)
    out += text("<circle class=\"luminaire\" cx=\"", number(scale.x(mark.at.x)), "\" cy=\"", number(scale.y(mark.at.y)),
                "\" r=\"4.5\"><title>", xml_text(mark.name.empty() ? "luminaire" : mark.name), "</title></circle>\n");
  return out;
}

std::string legend_of(const Plan& plan, const Scale& scale, std::size_t number_of_plan) {
  const double left = scale.width() + 18, top = 20, height = std::min(std::max(scale.height() - 30, 90.0), 260.0);
  std::string out =
      text("<defs><linearGradient id=\"colours-", number_of_plan, "\" x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\">");
  for (int i = 0; i <= 16; ++i)
    out += text("<stop offset=\"", number(i / 16.0, 4), "\" stop-color=\"", hex(i * (kColours - 1) / 16), "\"/>");
  out += text("</linearGradient></defs>\n<text x=\"", number(left), "\" y=\"11\">lx</text>\n<rect x=\"", number(left),
              "\" y=\"", number(top), "\" width=\"16\" height=\"", number(height), "\" fill=\"url(#colours-",
              number_of_plan, ")\"/>\n");
  for (int i = 0; i <= 4; ++i) {
    const double t = i / 4.0;
    const double lux = plan.by_logarithm ? plan.lowest * std::pow(plan.highest / plan.lowest, t)
                                         : plan.lowest + (plan.highest - plan.lowest) * t;
    out += text("<text x=\"", number(left + 21), "\" y=\"", number(top + height * (1 - t) + 4), "\">", lux_label(lux),
                "</text>\n");
  }
  return out;
}

std::string scale_bar(const Scale& scale) {
  const double metres = round_down(scale.width() / 4 / scale.px);
  const double y = scale.height() + 14, end = kEdge + metres * scale.px;
  return text("<path class=\"scale\" d=\"M", number(kEdge), " ", number(y - 4), "V", number(y), "H", number(end), "V",
              number(y - 4), "\"/>\n<text x=\"", number(end + 6), "\" y=\"", number(y + 3), "\">",
              metres >= 0.1 ? number(metres) : text(metres), " m</text>\n");
}

}  // namespace

std::vector<double> isolux_levels(double lowest, double highest) {
  constexpr double kSeries[] = {1, 1.5, 2, 3, 5, 7.5};
  constexpr std::size_t kLeast = 3, kMost = 8;
  std::vector<double> levels;
  if (!(highest > 0) || !std::isfinite(highest)) return levels;
  lowest = std::max(lowest, highest * 1e-3);
  for (int power = static_cast<int>(std::floor(std::log10(lowest))); power <= std::log10(highest); ++power)
    for (const double step : kSeries)
      if (const double lux = step * std::pow(10, power); lux > lowest && lux < highest) levels.push_back(lux);
  if (levels.size() > kMost)  // half of the steps
    std::erase_if(levels, [](double lux) {
      const double step = lux / std::pow(10, std::floor(std::log10(lux) + 1e-9));
      return std::abs(step - 1.5) < 0.01 || std::abs(step - 3) < 0.01 || std::abs(step - 7.5) < 0.01;
    });
  if (levels.size() > kMost) levels.erase(levels.begin(), levels.end() - kMost);
  if (levels.size() < kLeast && highest > lowest) {
    levels.clear();
    const double step = round_down((highest - lowest) / kLeast);
    for (double k = std::floor(lowest / step) + 1; k * step < highest * (1 - 1e-12); ++k) levels.push_back(k * step);
  }
  return levels;
}

std::vector<Plan::Isolux> isolux_lines(const Lattice& lattice, const std::vector<double>& levels) {
  std::vector<Vec3> points;
  std::vector<float> value;
  for (std::size_t row = 0; row < lattice.rows; ++row)
    for (std::size_t column = 0; column < lattice.columns; ++column) {
      const PlanPoint p = lattice.place(static_cast<double>(column), static_cast<double>(row));
      points.push_back({p.x, p.y, 0});
      value.push_back(static_cast<float>(lattice.value[points.size() - 1]));
    }
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    if (std::isnan(value[a]) || std::isnan(value[b]) || std::isnan(value[c])) return;
    triangles.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)});
  };
  for (std::size_t row = 0; row + 1 < lattice.rows; ++row)
    for (std::size_t column = 0; column + 1 < lattice.columns; ++column) {
      const std::size_t a = row * lattice.columns + column, b = a + 1, d = a + lattice.columns, c = d + 1;
      add(a, b, c), add(a, c, d);
    }
  for (float& v : value)
    if (std::isnan(v)) v = 0;  // on no triangle
  std::vector<Plan::Isolux> lines;
  for (const IsoLine& iso : iso_lines(points, triangles, value, levels)) {
    Plan::Isolux& line = lines.emplace_back(Plan::Isolux{iso.level, {}});
    for (const Vec3& p : iso.points) line.line.push_back({p.x, p.y});
  }
  return lines;
}

std::string svg_of(const Plan& plan, std::size_t number_of_plan) {
  const Scale scale(plan);
  const double width = scale.width() + kLegend, height = std::max(scale.height(), 120.0) + kBelow;
  std::string out =
      text("<svg class=\"plan\" role=\"img\"", plan.layers.empty() ? "" : text(" data-plan=\"", number_of_plan, "\""),
           " viewBox=\"0 0 ", number(width), " ", number(height), "\" width=\"", number(width), "\">\n<title>",
           xml_text(plan.title), "</title>\n<clipPath id=\"frame-", number_of_plan, "\"><rect x=\"0\" y=\"0\" width=\"",
           number(scale.width() + 2 * kEdge), "\" height=\"", number(scale.height() + 2 * kEdge),
           "\"/></clipPath>\n<g clip-path=\"url(#frame-", number_of_plan, ")\">\n");
  if (plan.lattice) out += cells_of(plan, scale);
  for (std::size_t i = 0; i < plan.dots.size(); i += 1 + plan.dots.size() / kMostDots) {
    const Plan::Dot& dot = plan.dots[i];
    out += text("<circle class=\"dot\" cx=\"", number(scale.x(dot.at.x)), "\" cy=\"", number(scale.y(dot.at.y)),
                "\" r=\"5\" fill=\"", hex(colour_of(plan, dot.lux)), "\"/>\n");
  }
  const auto [lines, labels] = isolux_of(plan, scale);
  out += paths_of(plan.walls, "wall", scale) + paths_of(plan.panes, "pane", scale) + "<g class=\"lines\">" + lines +
         "</g>\n" + marks_of(plan, scale) + "<g class=\"labels\">" + labels + "</g></g>\n" +
         legend_of(plan, scale, number_of_plan) + scale_bar(scale);
  return out + "</svg>\n";
}

}  // namespace clerestory
