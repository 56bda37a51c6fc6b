#pragma once
// Light in one (grey) or three (linear R, G, B) channels.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace clerestory {

inline constexpr int kMaxChannels = 3;

/// One value per channel. Grey scenes use the first only; the others then hold the same value.
struct Spectrum {
  std::array<double, kMaxChannels> c{};

  constexpr Spectrum() = default;
  constexpr explicit Spectrum(double grey) : c{grey, grey, grey} {}
  constexpr Spectrum(double r, double g, double b) : c{r, g, b} {}

  constexpr double operator[](int k) const { return c[static_cast<std::size_t>(k)]; }
  constexpr double& operator[](int k) { return c[static_cast<std::size_t>(k)]; }
  constexpr Spectrum& operator+=(const Spectrum& b) { return *this = {c[0] + b.c[0], c[1] + b.c[1], c[2] + b.c[2]}; }
  constexpr Spectrum& operator*=(const Spectrum& b) { return *this = {c[0] * b.c[0], c[1] * b.c[1], c[2] * b.c[2]}; }
  constexpr Spectrum& operator*=(double s) { return *this = {c[0] * s, c[1] * s, c[2] * s}; }
  friend constexpr bool operator==(const Spectrum&, const Spectrum&) = default;

  constexpr double max() const { return std::max({c[0], c[1], c[2]}); }
  constexpr double min() const { return std::min({c[0], c[1], c[2]}); }
  constexpr bool is_grey() const { return c[0] == c[1] && c[1] == c[2]; }
  constexpr bool is_black() const { return c[0] == 0 && c[1] == 0 && c[2] == 0; }
};

constexpr Spectrum operator+(const Spectrum& a, const Spectrum& b) { return Spectrum(a) += b; }
constexpr Spectrum operator-(const Spectrum& a, const Spectrum& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
constexpr Spectrum operator*(const Spectrum& a, const Spectrum& b) { return Spectrum(a) *= b; }
constexpr Spectrum operator*(const Spectrum& a, double s) { return Spectrum(a) *= s; }
constexpr Spectrum operator*(double s, const Spectrum& a) { return Spectrum(a) *= s; }
constexpr Spectrum operator/(const Spectrum& a, double s) { return Spectrum(a) *= 1 / s; }

/// n values of 1 or 3 channels, element by element: value[i * channels + k].
struct Field {
  int channels = 1;
  std::vector<double> value;

  Field() = default;
  Field(std::size_t n, int channel_count)
      : channels(channel_count), value(n * static_cast<std::size_t>(channel_count)) {}

  std::size_t size() const { return value.size() / static_cast<std::size_t>(channels); }
  double& at(std::size_t i, int k) {
    return value[i * static_cast<std::size_t>(channels) + static_cast<std::size_t>(k)];
  }
  double at(std::size_t i, int k) const {
    return value[i * static_cast<std::size_t>(channels) + static_cast<std::size_t>(k)];
  }
  Spectrum operator[](std::size_t i) const {
    return channels == 1 ? Spectrum(at(i, 0)) : Spectrum(at(i, 0), at(i, 1), at(i, 2));
  }
  void set(std::size_t i, const Spectrum& s) {
    for (int k = 0; k < channels; ++k) at(i, k) = s[k];
  }
  void add(std::size_t i, const Spectrum& s) {
    for (int k = 0; k < channels; ++k) at(i, k) += s[k];
  }
};

/// Whether all values are numbers.
inline bool all_finite(const Spectrum& s) { return std::isfinite(s[0]) && std::isfinite(s[1]) && std::isfinite(s[2]); }
inline bool all_finite(const Field& field) {
  return std::all_of(field.value.begin(), field.value.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace clerestory
