#include "solver/annual/sky_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/model/assert.h"

namespace clerestory {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::array<std::size_t, 7> kTregenza{30, 30, 24, 24, 18, 12, 6};  ///< parts of each row, from the horizon up

/// How often Tregenza's rows are parted.
std::size_t parting(std::size_t count) {
  const auto m = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(count - 1) / 144)));
  CLERESTORY_ASSERT(144 * m * m + 1, ==, count);
  return m;
}

/// f(chi) of a shape over sin(chi / 2): within 1e-3 of the brightest sky there is, and an exponential for each of few
/// entries instead of each of thousands of directions.
class Indicatrix {
 public:
  explicit Indicatrix(const SkyShape& shape) {
    for (std::size_t k = 0; k < value_.size(); ++k) {
      const double half = std::asin(std::min(1.0, static_cast<double>(k) / kSteps));
      value_[k] = shape.indicatrix(2 * half, std::cos(2 * half));
    }
  }
  double operator()(double cos_chi) const {
    const double place = kSteps * std::sqrt(std::clamp(0.5 - 0.5 * cos_chi, 0.0, 1.0));
    const auto i = static_cast<std::size_t>(place);
    return value_[i] + (place - static_cast<double>(i)) * (value_[i + 1] - value_[i]);
  }

 private:
  static constexpr std::size_t kSteps = 512;
  std::array<double, kSteps + 2> value_;
};

}  // namespace

SkyParts::SkyParts(std::size_t count) {
  const std::size_t m = parting(count);
  side_ = m == 1 ? 6 : m == 2 ? 3 : 2;  // samples half the size of the sun's glow
  row_height_ = kPi / 2 / (static_cast<double>(7 * m) + 0.5);
  row_begin_ = {0};
  for (std::size_t row = 0; row < 7 * m; ++row) row_begin_.push_back(row_begin_.back() + m * kTregenza[row / m]);
  row_begin_.push_back(row_begin_.back() + 1);
  CLERESTORY_ASSERT(this->count(), ==, count);
  const auto squared = [](double x) { return x * x; };
  for (std::size_t row = 0; row + 1 < row_begin_.size(); ++row) {
    const std::size_t parts = row_begin_[row + 1] - row_begin_[row];
    const bool is_cap = parts == 1;
    const double low = squared(std::sin(row_height_ * static_cast<double>(row)));
    const double high = is_cap ? 1 : squared(std::sin(row_height_ * static_cast<double>(row + 1)));
    for (std::size_t k = 0; k < parts; ++k) {
      on_horizontal_.push_back(kPi * (high - low) / static_cast<double>(parts));
      for (std::size_t i = 0; i < side_; ++i)
        for (std::size_t j = 0; j < side_; ++j) {
          // Even steps of sin^2 of the elevation are even shares of the integral.
          const double sin2 = low + (high - low) * (static_cast<double>(i) + 0.5) / static_cast<double>(side_);
          const double turn = (static_cast<double>(k) + (static_cast<double>(j) + 0.5) / static_cast<double>(side_)) /
                              static_cast<double>(parts) * 2 * kPi;
          const double flat = std::sqrt(1 - sin2);
          sample_.push_back({flat * std::sin(turn), flat * std::cos(turn), std::sqrt(sin2)});
        }
    }
  }
}

std::size_t SkyParts::part_of(const Vec3& d) const {
  if (d.z < 0) return ground();
  const auto row =
      std::min(static_cast<std::size_t>(std::asin(std::min(d.z, 1.0)) / row_height_), row_begin_.size() - 2);
  const std::size_t parts = row_begin_[row + 1] - row_begin_[row];
  double turn = std::atan2(d.x, d.y) / (2 * kPi);
  if (turn < 0) turn += 1;
  return row_begin_[row] + std::min(static_cast<std::size_t>(turn * static_cast<double>(parts)), parts - 1);
}

Vec3 SkyParts::middle(std::size_t part) const {
  Vec3 sum;
  for (const Vec3& d : std::span(sample_).subspan(first_sample(part), samples_a_part())) sum += d;
  return normalized(sum);
}

std::vector<float> SkyParts::on_plane(const Vec3& n) const {
  std::vector<float> seen(count() + 1);
  double sum = 0;
  for (std::size_t part = 0; part < count(); ++part) {
    double of_part = 0;
    for (const Vec3& d : std::span(sample_).subspan(first_sample(part), samples_a_part()))
      of_part += std::max(0.0, dot(n, d)) / d.z;  // samples share on_horizontal, whose weight is cos(zenith angle)
    of_part *= on_horizontal_[part] / static_cast<double>(samples_a_part());
    seen[part] = static_cast<float>(of_part);
    sum += of_part;
  }
  // A plane that leans back sees (1 + cos) / 2 of pi above the horizon.
  const double sky = kPi * (1 + n.z) / 2;
  for (std::size_t part = 0; part < count() && sum > 0; ++part) seen[part] *= static_cast<float>(sky / sum);
  seen[ground()] = static_cast<float>(kPi - sky);
  return seen;
}

void SkyParts::look_at(const SkyShape& shape, const Vec3& sun, double horizontal, std::span<float> radiance) const {
  CLERESTORY_ASSERT(radiance.size(), ==, count());
  const Indicatrix f(shape);
  double sum = 0;
  std::vector<double> gradation(side_);
  for (std::size_t row = 0; row + 1 < row_begin_.size(); ++row) {
    for (std::size_t i = 0; i < side_; ++i)
      gradation[i] = shape.gradation(sample_[first_sample(row_begin_[row]) + i * side_].z);
    for (std::size_t part = row_begin_[row]; part < row_begin_[row + 1]; ++part) {
      const Vec3* d = &sample_[first_sample(part)];
      double of_part = 0;
      for (std::size_t i = 0; i < side_; ++i) {
        double ring = 0;
        for (std::size_t j = 0; j < side_; ++j) ring += f(dot(*d++, sun));
        of_part += gradation[i] * ring;
      }
      radiance[part] = static_cast<float>(of_part);
      sum += of_part * on_horizontal_[part];
    }
  }
  const auto scale = static_cast<float>(sum > 0 ? horizontal / sum : 0);
  for (float& L : radiance) L *= scale;
}

}  // namespace clerestory
