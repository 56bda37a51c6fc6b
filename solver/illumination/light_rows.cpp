#include "solver/illumination/light_rows.h"

#include <algorithm>

#include "solver/model/parallel.h"
#include "solver/sampling/packed_direction.h"

namespace clerestory {
namespace {

constexpr std::uint32_t kLight = 1u << 30, kSky = 2u << 30;
static_assert(kDirectionBits == 30);

RowEntry entry(std::uint32_t source, const Spectrum& weight) {
  return {source, {static_cast<float>(weight[0]), static_cast<float>(weight[1]), static_cast<float>(weight[2])}};
}

}  // namespace

RowEntry RowEntry::of_patch(PatchId patch, const Spectrum& weight) { return entry(patch.value, weight); }
RowEntry RowEntry::of_sky(std::uint32_t packed_direction, const Spectrum& weight) {
  return entry(kSky | packed_direction, weight);
}
RowEntry RowEntry::of_light(std::size_t number, const Spectrum& weight) {
  return entry(kLight | static_cast<std::uint32_t>(number), weight);
}

void add_to_row(LightRow& row, std::size_t light, const Spectrum& E) {
  for (RowEntry& entry : row)
    if (entry.is_of_light() && entry.number() == light) {
      for (std::size_t c = 0; c < entry.weight.size(); ++c) entry.weight[c] += static_cast<float>(E.c[c]);
      return;
    }
  row.push_back(RowEntry::of_light(light, E));
}

RowLight::RowLight(std::span<const Layer> layers, int channels, const Field& B)
    : channels_(channels), lanes_(layers.size() * static_cast<std::size_t>(channels)), B_(B) {
  for (const Layer& layer : layers) {
    lights_ = std::max(lights_, layer.lights.size());
    sky_.push_back(layer.sky);
  }
  factor_.resize(lights_ * lanes_);
  for (std::size_t s = 0; s < layers.size(); ++s)
    for (std::size_t k = 0; k < layers[s].lights.size(); ++k)
      for (int c = 0; c < channels; ++c)
        factor_[k * lanes_ + s * static_cast<std::size_t>(channels) + static_cast<std::size_t>(c)] =
            layers[s].lights[k][c];
}

template <std::size_t C>
void RowLight::add_row(std::span<const RowEntry> row, double* E) const {
  const auto add_lanes = [&](const RowEntry& e, const double* given) {
    for (std::size_t l = 0; l < lanes_; l += C)
      for (std::size_t c = 0; c < C; ++c) E[l + c] += double{e.weight[c]} * given[l + c];
  };
  for (const RowEntry& e : row) {
    const std::size_t number = e.number();
    if (e.is_of_sky()) {
      const Vec3 d = unpack_direction(e.number());
      for (std::size_t s = 0; s < sky_.size(); ++s) {
        if (!sky_[s]) continue;
        const Spectrum L = (*sky_[s])(d);
        for (std::size_t c = 0; c < C; ++c) E[s * C + c] += double{e.weight[c]} * L.c[c];
      }
    } else if (e.is_of_light()) {
      if (number < lights_) add_lanes(e, factor_.data() + number * lanes_);
    } else {
      add_lanes(e, B_.value.data() + number * lanes_);
    }
  }
}
template void RowLight::add_row<1>(std::span<const RowEntry>, double*) const;
template void RowLight::add_row<3>(std::span<const RowEntry>, double*) const;

Field irradiance(const LightRows& rows, const RowLight& light) {
  Field E(rows.size(), static_cast<int>(light.lanes()));
  parallel_for(rows.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      light.add(rows[i], E.value.data() + i * light.lanes());
      // A row holds differences from means too: where it is all but dark they may leave less than nothing.
      for (double& e : lanes_of(E, i)) e = std::max(0.0, e);
    }
  });
  return E;
}

void divide_among_layers(const Spectrum& E, int channels, std::span<double> lanes) {
  const auto C = static_cast<std::size_t>(channels);
  for (std::size_t c = 0; c < C; ++c) {
    double sum = 0;
    for (std::size_t l = c; l < lanes.size(); l += C) sum += lanes[l] = std::max(0.0, lanes[l]);
    if (!(sum > 0)) continue;
    for (std::size_t l = c; l < lanes.size(); l += C) lanes[l] *= E.c[c] / sum;
  }
}

Field one_layer(const Field& lanes, std::size_t layer, int channels) {
  Field out(lanes.size(), channels);
  for (std::size_t i = 0; i < out.size(); ++i)
    for (int c = 0; c < channels; ++c) out.at(i, c) = lanes.at(i, static_cast<int>(layer) * channels + c);
  return out;
}

void set_layer(const Field& of_layer, std::size_t layer, Field& lanes) {
  for (std::size_t i = 0; i < lanes.size(); ++i)
    for (int c = 0; c < of_layer.channels; ++c)
      lanes.at(i, static_cast<int>(layer) * of_layer.channels + c) = of_layer.at(i, c);
}

}  // namespace clerestory
