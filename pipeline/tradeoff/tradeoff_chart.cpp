#include "pipeline/tradeoff/tradeoff_chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "pipeline/wording.h"

namespace clerestory {
namespace {

using Anchor = Chart::Anchor;

constexpr int kWidth = 860, kHeight = 520;
constexpr double kLeft = 80, kRight = 680, kTop = 60, kBottom = 450, kLetters = 20;
constexpr Ink kBlack{30, 30, 30}, kGrey{225, 225, 225}, kFront{196, 196, 196}, kWhite{255, 255, 255};
/// Told apart by those who see few colours, too. Source: Okabe & Ito, "Color universal design", 2008.
constexpr std::array<Ink, 7> kInks = {
    {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {230, 159, 0}, {86, 180, 233}, {90, 90, 90}}};

/// From a factor of the least to a factor of the most of some positive values, in logarithms.
struct Scale {
  double low, high, from, to;

  Scale(std::vector<double> values, double from_pixel, double to_pixel) : from(from_pixel), to(to_pixel) {
    const auto [least, most] = std::ranges::minmax(values);
    low = std::log10(least) - 0.12, high = std::log10(most) + 0.12;
    if (high - low < 0.7) {  // at least a factor of five is seen
      const double more = (0.7 - (high - low)) / 2;
      low -= more, high += more;
    }
  }
  double at(double value) const { return from + (std::log10(value) - low) / (high - low) * (to - from); }
  /// 1, 2 and 5 times powers of ten; powers alone where those are many.
  std::vector<double> ticks() const {
    std::vector<double> ticks;
    for (int power = static_cast<int>(std::floor(low)); power <= high; ++power)
      for (const double digit : {1.0, 2.0, 5.0})
        if (const double tick = digit * std::pow(10.0, power);
            std::log10(tick) >= low && std::log10(tick) <= high && (digit == 1 || high - low < 3.2))
          ticks.push_back(tick);
    return ticks;
  }
};

std::string short_number(double value) { return rounded(value, 1); }

}  // namespace

Chart tradeoff_chart(const Tradeoff& tradeoff) {
  Chart chart{kWidth, kHeight, {}};
  const auto line = [&](double x1, double y1, double x2, double y2, double width, Ink ink) {
    chart.shapes.push_back(Chart::Line{x1, y1, x2, y2, width, ink});
  };
  const auto disc = [&](double x, double y, double radius, Ink ink) {
    chart.shapes.push_back(Chart::Disc{x, y, radius, ink});
  };
  const auto words = [&](double x, double y, Anchor anchor, const std::string& text, Ink ink = kBlack,
                         double size = kLetters) {
    chart.shapes.push_back(Chart::Words{x, y, size, anchor, text, ink});
  };

  std::vector<const Tradeoff::Row*> rows;
  for (const Tradeoff::Row& row : tradeoff.rows)
    if (row.worst.rms > 0 && row.wall_s > 0) rows.push_back(&row);
  if (rows.empty()) {
    words(kWidth / 2.0, kHeight / 2.0, Anchor::middle, "no run ended");
    return chart;
  }
  std::vector<double> times, errors;
  for (const auto* row : rows) times.push_back(row->wall_s), errors.push_back(row->worst.rms);
  const Scale x(times, kLeft, kRight), y(errors, kBottom, kTop);

  for (const double tick : x.ticks()) {
    line(x.at(tick), kTop, x.at(tick), kBottom, 1, kGrey);
    words(x.at(tick), kBottom + 24, Anchor::middle, short_number(tick));
  }
  for (const double tick : y.ticks()) {
    line(kLeft, y.at(tick), kRight, y.at(tick), 1, kGrey);
    words(kLeft - 10, y.at(tick) + 6, Anchor::end, short_number(100 * tick) + " %");
  }
  line(kLeft, kBottom, kRight, kBottom, 1.5, kBlack);
  line(kLeft, kTop, kLeft, kBottom, 1.5, kBlack);
  words(kLeft - 70, kTop - 28, Anchor::start, "rms error in the worst room");
  words((kLeft + kRight) / 2, kBottom + 54, Anchor::middle, "time on the clock [s]");

  std::vector<const Tradeoff::Row*> front = rows;
  std::erase_if(front, [](const auto* row) { return !row->at_front; });
  std::ranges::sort(front, {}, [](const auto* row) { return row->wall_s; });
  for (std::size_t k = 1; k < front.size(); ++k)
    line(x.at(front[k - 1]->wall_s), y.at(front[k - 1]->worst.rms), x.at(front[k]->wall_s), y.at(front[k]->worst.rms),
         9, kFront);
  for (const auto* row : front) disc(x.at(row->wall_s), y.at(row->worst.rms), 13, kFront);

  std::vector<std::string> methods;
  for (const auto* row : rows)
    if (std::ranges::find(methods, row->method) == methods.end()) methods.push_back(row->method);
  double legend = kTop + 10;
  for (std::size_t k = 0; k < methods.size(); ++k) {
    const Ink ink = kInks[k % kInks.size()];
    const Tradeoff::Row* last = nullptr;
    for (const auto* row : rows) {
      if (row->method != methods[k]) continue;
      if (last) line(x.at(last->wall_s), y.at(last->worst.rms), x.at(row->wall_s), y.at(row->worst.rms), 1.5, ink);
      last = row;
    }
    for (const auto* row : rows) {
      if (row->method != methods[k]) continue;
      const double at_x = x.at(row->wall_s), at_y = y.at(row->worst.rms);
      disc(at_x, at_y, 6, ink);
      if (row->worst.bound) disc(at_x, at_y, 3.5, kWhite);
      const std::size_t word = row->settings.rfind(' ');
      words(at_x + 9, at_y - 8, Anchor::start, row->settings.substr(word == std::string::npos ? 0 : word + 1, 1), ink);
    }
    disc(kRight + 24, legend - 6, 6, ink);
    words(kRight + 36, legend, Anchor::start, methods[k], ink, 18);
    legend += 26;
  }
  line(kRight + 16, legend - 4, kRight + 32, legend - 4, 9, kFront);
  words(kRight + 36, legend + 1, Anchor::start, "front", kBlack, 18);
  if (std::ranges::any_of(rows, [](const auto* row) { return row->worst.bound; })) {
    legend += 26;
    disc(kRight + 24, legend - 6, 6, kBlack), disc(kRight + 24, legend - 6, 3.5, kWhite);
    words(kRight + 36, legend, Anchor::start, "at most", kBlack, 18);
  }
  return chart;
}

}  // namespace clerestory
