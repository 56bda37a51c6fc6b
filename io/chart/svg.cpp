#include <cstdio>

#include "io/chart/chart.h"
#include "io/text.h"

namespace clerestory {
namespace {

std::string number(double x) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.1f", x);
  return digits;
}

std::string code(const Ink& ink) {
  char digits[8];
  std::snprintf(digits, sizeof digits, "#%02x%02x%02x", ink.r, ink.g, ink.b);
  return digits;
}

std::string element(const Chart::Line& l) {
  return text("<line x1=\"", number(l.x1), "\" y1=\"", number(l.y1), "\" x2=\"", number(l.x2), "\" y2=\"", number(l.y2),
              "\" stroke=\"", code(l.ink), "\" stroke-width=\"", number(l.width), "\" stroke-linecap=\"round\"/>\n");
}

std::string element(const Chart::Disc& d) {
  return text("<circle cx=\"", number(d.x), "\" cy=\"", number(d.y), "\" r=\"", number(d.radius), "\" fill=\"",
              code(d.ink), "\"/>\n");
}

std::string element(const Chart::Words& w) {
  constexpr const char* kAnchors[] = {"start", "middle", "end"};
  return text("<text x=\"", number(w.x), "\" y=\"", number(w.y), "\" font-size=\"", number(w.size), "\" fill=\"",
              code(w.ink), "\" text-anchor=\"", kAnchors[static_cast<std::size_t>(w.anchor)], "\">", xml_text(w.text),
              "</text>\n");
}

}  // namespace

std::string svg_of(const Chart& chart) {
  std::string out = text("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 ", chart.width, " ", chart.height,
                         "\" width=\"", chart.width, "\" height=\"", chart.height,
                         "\" font-family=\"sans-serif\">\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n");
  for (const auto& shape : chart.shapes) out += std::visit([](const auto& s) { return element(s); }, shape);
  return out + "</svg>\n";
}

}  // namespace clerestory
