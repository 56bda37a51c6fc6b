#include "meshing/atlas/fit_texels.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "meshing/atlas/plane_on_texels.h"
#include "meshing/atlas/raster.h"

namespace clerestory {
namespace {

constexpr int kPerCell = 3;           // samples each way
constexpr double kRimWeight = 1;      // of a sample on the rim, a ninth is that of one inside
constexpr double kEdgeWeight = 0.03;  // of one on an edge between triangles
constexpr double kPointWeight = 0.1;  // of one on a point
constexpr double kDark = 1e-3;        // of the chart's largest value: below it errors count as if it were this
constexpr double kStay = 1e-3;        // weight of x0; that of all samples around a texel is 0.44
constexpr int kRounds = 60;
constexpr double kSolved = 1e-7;  // residual, as a share of the first

/// Normal equations on a grid. Of the symmetric matrix, each texel's row holds itself and the four neighbours that come
/// after it: right; left, middle and right below.
class Equations {
 public:
  Equations(int width, int height, int channels)
      : width_(static_cast<std::size_t>(width)),
        height_(static_cast<std::size_t>(height)),
        channels_(static_cast<std::size_t>(channels)),
        row_(width_ * height_),
        start_weight_(row_.size(), 0.0),
        right_side_(row_.size() * channels_, 0.0),
        start_(right_side_.size(), 0.0) {}

  /// A sample at (x, y): its values, and the planes that they are of.
  void add(double x, double y, double weight, std::span<const double> f, std::span<const PlaneOnTexels> planes) {
    const auto i = std::min(static_cast<std::size_t>(x), width_ - 2),
               j = std::min(static_cast<std::size_t>(y), height_ - 2);
    const double s = x - static_cast<double>(i), t = y - static_cast<double>(j);
    const std::size_t at = j * width_ + i;
    const std::array<std::size_t, 4> texel{at, at + 1, at + width_, at + width_ + 1};
    const std::array<double, 4> b{(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t};
    Row &r0 = row_[texel[0]], &r1 = row_[texel[1]], &r2 = row_[texel[2]], &r3 = row_[texel[3]];
    r0[0] += weight * b[0] * b[0], r1[0] += weight * b[1] * b[1];
    r2[0] += weight * b[2] * b[2], r3[0] += weight * b[3] * b[3];
    r0[1] += weight * b[0] * b[1], r2[1] += weight * b[2] * b[3];
    r1[2] += weight * b[1] * b[2];
    r0[3] += weight * b[0] * b[2], r1[3] += weight * b[1] * b[3];
    r0[4] += weight * b[0] * b[3];
    for (std::size_t k = 0; k < 4; ++k) {
      const double w = weight * b[k];
      start_weight_[texel[k]] += w;
      const double cx = static_cast<double>(i + k % 2), cy = static_cast<double>(j + k / 2);
      for (std::size_t c = 0; c < channels_; ++c) {
        right_side_[texel[k] * channels_ + c] += weight * b[k] * f[c];
        start_[texel[k] * channels_ + c] += w * planes[c].beyond(cx, cy);
      }
    }
  }

  /// The texels of a cell that a triangle touches: they go on as its planes do where no sample says more.
  void touch(int column, int row, std::span<const PlaneOnTexels> planes) {
    const std::size_t at = static_cast<std::size_t>(row) * width_ + static_cast<std::size_t>(column);
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t i = at + k % 2 + k / 2 * width_;
      start_weight_[i] += kTouch;
      for (std::size_t c = 0; c < channels_; ++c)
        start_[i * channels_ + c] +=
            kTouch * planes[c].beyond(column + static_cast<double>(k % 2), row + static_cast<double>(k / 2));
    }
  }

  bool is_reached(std::size_t i) const { return start_weight_[i] > 0; }

  /// Width x height x channels. Where the values' lowest is not below 0, no texel is.
  std::vector<double> solve(std::span<const double> lowest, double floor) {
    for (std::size_t i = 0; i < row_.size(); ++i) {
      if (!is_reached(i)) continue;
      double* const x0 = &start_[i * channels_];
      for (std::size_t c = 0; c < channels_; ++c) {
        x0[c] /= start_weight_[i];
        if (lowest[c] >= 0) x0[c] = std::max(x0[c], 0.0);
      }
      const double shown = std::max(x0[0], floor), stay = kStay / (shown * shown);
      row_[i][0] += stay;
      for (std::size_t c = 0; c < channels_; ++c) right_side_[i * channels_ + c] += stay * x0[c];
    }
    std::vector<double> x(right_side_.size());
    for (std::size_t c = 0; c < channels_; ++c) {
      std::vector<double> one = conjugate_gradients(c);
      if (lowest[c] >= 0) keep_above_zero(one, c);
      for (std::size_t i = 0; i < one.size(); ++i) x[i * channels_ + c] = one[i];
    }
    return x;
  }

 private:
  using Row = std::array<double, 5>;
  static constexpr double kTouch = 1e-30;

  /// y = A x
  void multiply(const std::vector<double>& x, std::vector<double>& y) const {
    std::fill(y.begin(), y.end(), 0.0);
    for (std::size_t j = 0; j < height_; ++j)
      for (std::size_t i = 0; i < width_; ++i) {
        const std::size_t at = j * width_ + i;
        const Row& r = row_[at];
        double sum = r[0] * x[at];
        const auto pair = [&](std::size_t other, double a) { sum += a * x[other], y[other] += a * x[at]; };
        if (i + 1 < width_) pair(at + 1, r[1]);
        if (j + 1 < height_) {
          if (i > 0) pair(at + width_ - 1, r[2]);
          pair(at + width_, r[3]);
          if (i + 1 < width_) pair(at + width_ + 1, r[4]);
        }
        y[at] += sum;
      }
  }

  /// Source: Shewchuk, "An introduction to the conjugate gradient method without the agonizing pain", 1994, B3; the
  /// preconditioner is the diagonal.
  std::vector<double> conjugate_gradients(std::size_t c) const {
    const std::size_t n = row_.size();
    std::vector<double> x(n), r(n), d(n), q(n), inverse(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      x[i] = start_[i * channels_ + c];
      if (row_[i][0] > 0) inverse[i] = 1 / row_[i][0];
    }
    multiply(x, q);
    double rho = 0, first = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double b = right_side_[i * channels_ + c];
      r[i] = b - q[i], d[i] = inverse[i] * r[i];
      rho += r[i] * d[i], first += b * b * inverse[i];
    }
    for (int round = 0; round < kRounds && rho > kSolved * kSolved * first; ++round) {
      multiply(d, q);
      double dq = 0;
      for (std::size_t i = 0; i < n; ++i) dq += d[i] * q[i];
      const double alpha = rho / dq;
      double next = 0;
      for (std::size_t i = 0; i < n; ++i) {
        x[i] += alpha * d[i], r[i] -= alpha * q[i];
        next += r[i] * r[i] * inverse[i];
      }
      const double beta = next / rho;
      rho = next;
      for (std::size_t i = 0; i < n; ++i) d[i] = inverse[i] * r[i] + beta * d[i];
    }
    return x;
  }

  /// Negative texels become 0, and their neighbours make up for it: projected Gauss-Seidel.
  void keep_above_zero(std::vector<double>& x, std::size_t c) const {
    if (std::ranges::all_of(x, [](double v) { return v >= 0; })) return;
    for (double& v : x) v = std::max(v, 0.0);
    for (int sweep = 0; sweep < 12; ++sweep)
      for (std::size_t j = 0; j < height_; ++j)
        for (std::size_t i = 0; i < width_; ++i) {
          const std::size_t at = j * width_ + i;
          if (!(row_[at][0] > 0)) continue;
          double rest = right_side_[at * channels_ + c];
          const auto less = [&](std::size_t other, double a) { rest -= a * x[other]; };
          if (i + 1 < width_) less(at + 1, row_[at][1]);
          if (i > 0) less(at - 1, row_[at - 1][1]);
          if (j + 1 < height_) {
            if (i > 0) less(at + width_ - 1, row_[at][2]);
            less(at + width_, row_[at][3]);
            if (i + 1 < width_) less(at + width_ + 1, row_[at][4]);
          }
          if (j > 0) {
            const std::size_t up = at - width_;
            if (i + 1 < width_) less(up + 1, row_[up + 1][2]);
            less(up, row_[up][3]);
            if (i > 0) less(up - 1, row_[up - 1][4]);
          }
          x[at] = std::max(0.0, rest / row_[at][0]);
        }
  }

  std::size_t width_, height_, channels_;
  std::vector<Row> row_;
  std::vector<double> start_weight_, right_side_, start_;
};

/// Texels that nothing reaches get the value of the nearest that something does.
void repeat_nearest(int width, int height, std::size_t channels, std::vector<std::uint8_t>& is_known,
                    std::vector<float>& value) {
  std::vector<std::size_t> front;
  for (std::size_t i = 0; i < is_known.size(); ++i)
    if (is_known[i]) front.push_back(i);
  const auto w = static_cast<std::size_t>(width);
  for (std::size_t k = 0; k < front.size(); ++k) {
    const std::size_t at = front[k], i = at % w;
    const auto take = [&](std::size_t other) {
      if (is_known[other]) return;
      is_known[other] = 1;
      std::copy_n(value.begin() + static_cast<std::ptrdiff_t>(at * channels), channels,
                  value.begin() + static_cast<std::ptrdiff_t>(other * channels));
      front.push_back(other);
    };
    if (i > 0) take(at - 1);
    if (i + 1 < w) take(at + 1);
    if (at >= w) take(at - w);
    if (at + w < w * static_cast<std::size_t>(height)) take(at + w);
  }
}

}  // namespace

std::vector<float> fit_texels(const WrittenResult& result, const AtlasChart& chart, const Field& value) {
  const auto channels = static_cast<std::size_t>(value.channels);
  std::vector<double> lowest(channels, 1e300);
  double brightest = 0;
  std::vector<std::array<std::uint32_t, 2>> inner;  // edges that two triangles of the chart have, once each
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const std::uint32_t t : chart.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t p = result.triangles[t][k];
      const auto [a, b] = std::minmax(p, result.triangles[t][(k + 1) % 3]);
      edges.push_back({a, b});
      for (std::size_t c = 0; c < channels; ++c) {
        lowest[c] = std::min(lowest[c], value.at(p, static_cast<int>(c)));
      }
      brightest = std::max(brightest, value.at(p, 0));
    }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 1; i < edges.size(); ++i)
    if (edges[i] == edges[i - 1]) inner.push_back(edges[i]);
  const double floor = std::max(kDark * brightest, 1e-30);

  Equations equations(chart.width, chart.height, value.channels);
  std::vector<double> f(channels);
  std::vector<PlaneOnTexels> planes(channels);
  for (const std::uint32_t t : chart.triangles) {
    const auto& points = result.triangles[t];
    std::array<Texel, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) corner[k] = chart.texel_of(result.points[points[k]]);
    for (std::size_t c = 0; c < channels; ++c) {
      const auto at = [&](std::size_t k) { return value.at(points[k], static_cast<int>(c)); };
      planes[c] = plane_of(corner, {at(0), at(1), at(2)});
    }
    const auto add = [&](double x, double y, double weight) {
      const double shown = std::max(f[0], floor);
      equations.add(x, y, weight / (shown * shown), f, planes);
    };
    for_rows_of_cells(corner, chart.width - 1, chart.height - 1, [&](int row, int first, int last) {
      for (int column = first; column <= last; ++column) equations.touch(column, row, planes);
    });
    const auto [low, high] = std::minmax({corner[0][1], corner[1][1], corner[2][1]});
    const auto next = [](double x) { return std::max(0.0, std::ceil(x * kPerCell - 0.5)); };
    for (double j = next(low); (j + 0.5) / kPerCell <= high; ++j) {
      const double y = (j + 0.5) / kPerCell;
      const auto [left, right] = x_range(corner, y, y);
      for (double i = next(left); (i + 0.5) / kPerCell <= right; ++i) {
        const double x = (i + 0.5) / kPerCell;
        for (std::size_t c = 0; c < channels; ++c) f[c] = planes[c](x, y);
        add(x, y, 1.0 / (kPerCell * kPerCell));
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3;
      const auto [a, b] = std::minmax(points[k], points[l]);
      const bool is_inner = std::binary_search(inner.begin(), inner.end(), std::array<std::uint32_t, 2>{a, b});
      const double edge_length = std::hypot(corner[l][0] - corner[k][0], corner[l][1] - corner[k][1]);
      const int parts = std::max(1, static_cast<int>(std::ceil(2 * edge_length)));
      for (int i = 0; i < parts; ++i) {
        const double s = static_cast<double>(i) / parts;
        for (std::size_t c = 0; c < channels; ++c)
          f[c] = (1 - s) * value.at(points[k], static_cast<int>(c)) + s * value.at(points[l], static_cast<int>(c));
        const double weight = (is_inner ? kEdgeWeight : kRimWeight) * std::min(1.0, edge_length);
        add((1 - s) * corner[k][0] + s * corner[l][0], (1 - s) * corner[k][1] + s * corner[l][1],
            i == 0 ? std::max(weight, kPointWeight) : weight);
      }
    }
  }

  const std::vector<double> x = equations.solve(lowest, floor);
  std::vector<float> texels(x.begin(), x.end());
  std::vector<std::uint8_t> is_known(x.size() / channels);
  for (std::size_t i = 0; i < is_known.size(); ++i) is_known[i] = equations.is_reached(i);
  repeat_nearest(chart.width, chart.height, channels, is_known, texels);
  return texels;
}

}  // namespace clerestory
