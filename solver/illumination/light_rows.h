#pragma once
// Irradiance as a row of weights: what was found by rays, for light that is not known yet.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "solver/lights/layers.h"
#include "solver/model/patch_set.h"

namespace clerestory {

/// E += weight * what the source gives. 16 bytes.
struct RowEntry {
  std::uint32_t source;
  std::array<float, kMaxChannels> weight;

  /// weight [1], of the patch's radiosity.
  static RowEntry of_patch(PatchId patch, const Spectrum& weight);
  /// weight [sr], of the sky's radiance.
  static RowEntry of_sky(std::uint32_t packed_direction, const Spectrum& weight);
  /// weight [W/m2], what the luminaire or sun of this number (as in Layer::lights) gives at factor 1.
  static RowEntry of_light(std::size_t number, const Spectrum& weight);

  bool is_of_light() const { return source >> 30 == 1; }
  bool is_of_sky() const { return source >> 30 == 2; }
  /// Of the patch or the light; of the sky its packed direction.
  std::uint32_t number() const { return source & ((1u << 30) - 1); }
  bool is_empty() const { return weight[0] == 0 && weight[1] == 0 && weight[2] == 0; }
  void scale(const Spectrum& by) {
    for (std::size_t c = 0; c < weight.size(); ++c) weight[c] *= static_cast<float>(by.c[c]);
  }
};
using LightRow = std::vector<RowEntry>;
/// Adds what that luminaire or sun gives to its entry, or to a new one.
void add_to_row(LightRow& row, std::size_t light, const Spectrum& E);

/// Rows of N receivers, one after another.
struct LightRows {
  std::vector<std::size_t> begin{0};  ///< N + 1
  std::vector<RowEntry> entries;

  std::size_t size() const { return begin.size() - 1; }
  std::span<const RowEntry> operator[](std::size_t i) const {
    return std::span(entries).subspan(begin[i], begin[i + 1] - begin[i]);
  }
  void append(std::span<const RowEntry> row) {
    entries.insert(entries.end(), row.begin(), row.end());
    begin.push_back(entries.size());
  }
};

/// The light of layers, side by side: lane s * channels + c is channel c of layer s.
class RowLight {
 public:
  /// B  N x lanes, radiosity of the patches in each layer [W/m2]; outlives this. Not looked at by rows without patches.
  RowLight(std::span<const Layer> layers, int channels, const Field& B);

  int channels() const { return channels_; }
  std::size_t lanes() const { return lanes_; }
  /// E (lanes) += row times light.
  void add(std::span<const RowEntry> row, double* E) const { channels_ == 1 ? add_row<1>(row, E) : add_row<3>(row, E); }

 private:
  template <std::size_t C>
  void add_row(std::span<const RowEntry> row, double* E) const;

  int channels_;
  std::size_t lanes_, lights_ = 0;
  const Field& B_;
  std::vector<double> factor_;  ///< lights x lanes
  std::vector<std::shared_ptr<const SkyRadiance>> sky_;
};

/// Of all rows. returns N x lanes, none negative [W/m2]. No rays. Threads: same bits for any thread count.
Field irradiance(const LightRows& rows, const RowLight& light);

/// Scales what layers give at a receiver so that they sum to E, which all of them give together. Where E is more than a
/// sum of rays (means put right, values clamped) layers share that in proportion; none gives less than nothing.
void divide_among_layers(const Spectrum& E, int channels, std::span<double> lanes);

/// Lanes of receiver i.
inline std::span<double> lanes_of(Field& x, std::size_t i) {
  const auto lanes = static_cast<std::size_t>(x.channels);
  return std::span(x.value).subspan(i * lanes, lanes);
}
inline std::span<const double> lanes_of(const Field& x, std::size_t i) {
  const auto lanes = static_cast<std::size_t>(x.channels);
  return std::span(x.value).subspan(i * lanes, lanes);
}

/// One layer of N x lanes, and the reverse.
Field one_layer(const Field& lanes, std::size_t layer, int channels);
void set_layer(const Field& of_layer, std::size_t layer, Field& lanes);

}  // namespace clerestory
