#include "solver/evaluate/error_figures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

namespace clerestory {
namespace {

constexpr double kFewPoints = 8;
constexpr double kNoChance = 2.5;  ///< standard errors: one part in eighty is taken for wrong that is not
/// The same where the residual says that it is right: paths that seldom find the light scatter to one side.
constexpr double kNoChanceAtAll = 4;

/// Weighted means over comparisons.
class Samples {
 public:
  explicit Samples(std::span<const Comparison> samples) : samples_(samples) {
    for (const Comparison& s : samples_) weights_ += s.weight / count();
  }
  double count() const { return static_cast<double>(samples_.size()); }
  template <class Of>
  double mean(const Of& of) const {
    double sum = 0;
    for (const Comparison& s : samples_) sum += share(s) * of(s) / count();
    return sum;
  }
  /// Whether the mean is not 0 by chance, and not by a hundredth of the points, or one, alone.
  template <class Of>
  bool is_no_chance(const Of& of, double std_errors) const {
    const double m = mean(of);
    if (!(std::abs(m) > std_errors * std_error(of))) return false;
    std::vector<double> terms;
    for (const Comparison& s : samples_) terms.push_back(share(s) * of(s) / count() * (m > 0 ? 1 : -1));
    std::ranges::sort(terms, std::greater<>());
    const auto few = static_cast<std::ptrdiff_t>(1 + terms.size() / 100);
    return std::accumulate(terms.begin() + few, terms.end(), 0.0) > std::abs(m) / 2;
  }
  template <class Is>
  bool all(const Is& is) const {
    return std::ranges::all_of(samples_, is);
  }
  /// Standard error of that mean.
  template <class Of>
  double std_error(const Of& of) const {
    const double m = mean(of);
    double squares = 0;
    for (const Comparison& s : samples_) squares += std::pow(share(s) * (of(s) - m), 2);
    return std::sqrt(squares) / count();
  }
  /// Standard deviation of the mean of what has these.
  template <class Of>
  double deviation(const Of& of) const {
    double squares = 0;
    for (const Comparison& s : samples_) squares += std::pow(share(s) * of(s), 2);
    return std::sqrt(squares) / count();
  }
  /// The value below which lies the share p of all.
  template <class Of>
  double percentile(double p, const Of& of) const {
    std::vector<std::pair<double, double>> values;
    for (const Comparison& s : samples_) values.push_back({of(s), share(s)});
    std::sort(values.begin(), values.end());
    double below = 0;
    return std::find_if(values.begin(), values.end() - 1,
                        [&](const auto& v) { return (below += v.second) > p * (count() - 1); })
        ->first;
  }

 private:
  double share(const Comparison& s) const { return s.weight / weights_; }  // 1 in the mean
  std::span<const Comparison> samples_;
  double weights_ = 0;
};

constexpr double kConfidence = 1.96;  ///< standard errors in the half-width of a 95 % interval

double squared(double x) { return x * x; }

/// What is known of the mean square error.
struct Squares {
  double mean = 0, half_width = 0;  ///< of its 95 % interval: which points were looked at, and noise
  double noise = 0;                 ///< the same of the references' noise alone
  double level = 0;                 ///< mean of the references
  double observed = 0;              ///< the mean square with the references' noise
  double also = 0;                  ///< an error that may be there as well [of level]
};

template <class ReferenceOf>
ErrorFigures figures_of(const Samples& samples, const Squares& s, const ReferenceOf& reference_of) {
  ErrorFigures e;
  e.samples = static_cast<std::size_t>(samples.count());
  // A few points may agree by chance.
  const double half_width = samples.count() < kFewPoints ? std::max(s.half_width, s.noise) : s.half_width;
  const double at_most = std::max(s.mean, 0.0) + half_width + squared(s.also * s.level);
  const double upper = std::sqrt(at_most) / s.level;
  e.bound = s.mean <= s.noise;
  e.rms_relative = e.bound ? upper : std::sqrt(s.mean) / s.level;
  e.confidence = e.bound ? upper : upper - e.rms_relative;
  // Right when errors are distributed like the noise, and too large when few large errors make up the variance. A
  // distribution fitted to what lies behind the noise was tried: it took tails for noise and was low by a quarter.
  const double left = e.bound ? at_most : s.mean;
  const double without_noise = s.observed > left ? std::sqrt(left / s.observed) : 1;
  const auto relative = [&](const Comparison& c) {
    // Points much darker than the mean would make a share of nothing.
    return std::abs(c.x - reference_of(c)) / std::max(reference_of(c), 0.05 * s.level);
  };
  e.median_relative = samples.percentile(0.5, relative) * without_noise;
  e.p95_relative = samples.percentile(0.95, relative) * without_noise;
  e.p99_relative = samples.percentile(0.99, relative) * without_noise;
  e.bias_relative = samples.mean([](const Comparison& c) { return c.x; }) / s.level - 1;
  return e;
}

ErrorFigures by_paths(const Samples& samples, double level) {
  const auto difference = [](const Comparison& c) { return squared(c.x - c.r) - squared(c.std_error); };
  // Of d2 - s2, e being what is not noise of d: 4 e2 s2 + 2 s4.
  const auto noise = [&](const Comparison& c) {
    return std::sqrt(4 * std::max(difference(c), 0.0) * squared(c.std_error) + 2 * squared(squared(c.std_error)));
  };
  Squares s{samples.mean(difference),
            kConfidence * samples.std_error(difference),
            kConfidence * samples.deviation(noise),
            level,
            0,
            0};
  s.observed = samples.mean([](const Comparison& c) { return squared(c.x - c.r); });
  return figures_of(samples, s, [](const Comparison& c) { return c.r; });
}

bool most_find_light(const Samples& samples) {
  return samples.mean([](const Comparison& c) { return c.r > 0 ? 1.0 : 0.0; }) > 0.5;
}

/// How far the light may be off in the mean [of level] for all that gathers and elements say of each other: the
/// residual of the radiosity equation, times 1 / (1 - albedo); any amount where elements are not known.
template <class Gathered>
double largest_by_residual(const Samples& samples, const Gathered& gathered, double level) {
  if (!samples.all([](const Comparison& c) { return c.element >= 0; })) return std::numeric_limits<double>::infinity();
  const auto residual = [&](const Comparison& c) { return (gathered(c) - c.element - c.off_mean) / level; };
  const double albedo = samples.mean([&](const Comparison& c) { return c.albedo * c.element; }) /
                        std::max(samples.mean([](const Comparison& c) { return c.element; }), 1e-30 * level);
  return (std::abs(samples.mean(residual)) + kConfidence * samples.std_error(residual)) / (1 - albedo);
}

ErrorFigures by_gathers(const Samples& samples) {
  const auto gathered = [](const Comparison& c) { return (c.gather + c.other_gather) / 2; };
  const double level = samples.mean(gathered);
  const auto off = [&](const Comparison& c) { return (c.r - gathered(c)) / level; };
  const double ratio = samples.mean(off);
  const double of_noise = samples.deviation([&](const Comparison& c) { return c.std_error / level; });
  const double ratio_error = kConfidence * std::max(samples.std_error(off), of_noise);
  // Where most paths find nothing, the few that do tell no mean.
  const bool paths_can_judge = most_find_light(samples);
  const double by_residual = largest_by_residual(samples, gathered, level);
  const double chance = std::abs(ratio) > by_residual ? kNoChanceAtAll : kNoChance;
  const bool is_off = paths_can_judge && samples.is_no_chance(off, chance);
  const double factor = is_off ? std::max(1 + ratio, 0.01) : 1;
  const auto reference = [&](const Comparison& c) { return factor * gathered(c); };
  const auto product = [&](const Comparison& c) { return (c.x - factor * c.gather) * (c.x - factor * c.other_gather); };
  // Of (x - g1)(x - g2), where g1 - g2 has twice the variance of each.
  const auto noise = [&](const Comparison& c) {
    const double d2 = squared(factor * (c.gather - c.other_gather));
    return std::sqrt(squared(c.x - reference(c)) * d2 + d2 * d2 / 4);
  };
  Squares s{samples.mean(product),
            kConfidence * samples.std_error(product),
            kConfidence * samples.deviation(noise),
            factor * level,
            0,
            paths_can_judge ? ratio_error : std::abs(ratio) + ratio_error};
  s.observed = samples.mean([&](const Comparison& c) { return squared(c.x - reference(c)); });
  if (paths_can_judge) s.also = std::min(s.also, by_residual);
  // Where gathers are wrong in some places only.
  const auto scatter = [&](const Comparison& c) { return squared(c.r - reference(c)) - squared(c.std_error); };
  // What a single bright path brings has a standard error like itself.
  const auto told = [&](const Comparison& c) {
    return std::abs(c.r - reference(c)) > 4 * c.std_error ? squared(c.r - reference(c)) : 0;
  };
  const double more = samples.mean(scatter);
  if (paths_can_judge && more > kNoChance * samples.std_error(scatter) && samples.mean(told) > more / 2) {
    s.mean += more;
    s.observed += more;
    s.half_width = std::hypot(s.half_width, kConfidence * samples.std_error(scatter));
  }
  return figures_of(samples, s, reference);
}

}  // namespace

ErrorFigures summarise(std::span<const Comparison> comparisons) {
  if (comparisons.empty()) return {};
  const Samples samples(comparisons);
  const double level = samples.mean([](const Comparison& c) { return c.r; });
  if (!std::isfinite(level)) throw std::logic_error("a reference of the measured error is no number");
  if (!(level > 0)) return {};  // in the dark there is nothing to be wrong about
  const bool has_gathers = std::ranges::all_of(comparisons, [](const Comparison& c) { return c.gather >= 0; }) &&
                           samples.mean([](const Comparison& c) { return c.gather + c.other_gather; }) > 0;
  if (!has_gathers) return by_paths(samples, level);
  // Chosen by their own noise, and not by what either says of the result.
  const double of_paths = samples.mean([](const Comparison& c) { return squared(c.std_error); });
  const double of_gathers = samples.mean([](const Comparison& c) { return squared(c.gather - c.other_gather); }) / 2;
  return most_find_light(samples) && of_paths < of_gathers / 2 ? by_paths(samples, level) : by_gathers(samples);
}

}  // namespace clerestory
