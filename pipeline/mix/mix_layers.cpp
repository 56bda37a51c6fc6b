#include "pipeline/mix/mix_layers.h"

#include <algorithm>
#include <optional>

#include "io/as_written.h"
#include "io/scene_file/nearest_name.h"
#include "io/some_of.h"
#include "io/text.h"
#include "pipeline/wording.h"
#include "solver/evaluate/sensor_summary.h"
#include "solver/lights/layers.h"
#include "solver/model/error.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

using Arrays = std::map<std::string, WrittenArray>;

bool is_as_before(std::span<const double> factors) {
  return std::ranges::all_of(factors, [](double f) { return f == 1; });
}

void scale(std::vector<float>& values, double factor) {
  for (float& x : values) x = static_cast<float>(x * factor);
}
void scale(std::vector<double>& values, double factor) {
  for (double& x : values) x *= factor;
}

/// Scales the array of each layer in place. returns their sum; nothing, and all is as it was, where a layer has none.
std::vector<double> scaled_sum(Arrays& arrays, const char* name, const std::vector<ShownLayer>& layers,
                               std::span<const double> factors) {
  if (!std::ranges::all_of(layers,
                           [&](const ShownLayer& layer) { return arrays.contains(of_layer(name, layer.name)); }))
    return {};
  std::vector<double> sum;
  for (std::size_t s = 0; s < layers.size(); ++s) {
    std::vector<float>& own = arrays.at(of_layer(name, layers[s].name)).value;
    scale(own, factors[s]);
    sum.resize(own.size());
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += own[k];
  }
  return sum;
}

void set(std::vector<float>& values, const std::vector<double>& to) {
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = static_cast<float>(to[k]);
}

void mix_arrays(Arrays& arrays, const std::vector<ShownLayer>& layers, std::span<const double> factors) {
  WrittenArray &E = arrays.at("irradiance"), &B = arrays.at("radiosity");
  const std::vector<double> E_now = scaled_sum(arrays, "irradiance", layers, factors),
                            B_now = scaled_sum(arrays, "radiosity", layers, factors);
  if (B_now.empty()) {
    for (std::size_t k = 0; k < E_now.size(); ++k)
      B.value[k] = E.value[k] > 0 ? static_cast<float>(B.value[k] * (E_now[k] / E.value[k])) : 0;
  } else {
    set(B.value, B_now);
  }
  set(E.value, E_now);
  arrays["illuminance"] = illuminance_of(E);
  arrays["luminance"] = luminance_of(B);
  for (std::size_t s = 0; s < layers.size(); ++s)
    if (const auto at = arrays.find(of_layer("illuminance", layers[s].name)); at != arrays.end())
      scale(at->second.value, factors[s]);
}

/// Illuminance on open ground that daylight factors are shares of now; none where other light than the sky's is left.
std::optional<double> reference_of(const SceneAround& around, std::span<const double> factors) {
  if (!around.daylight_reference || is_as_before(factors)) return around.daylight_reference;
  double of_sky = 0;
  for (std::size_t s = 0; s < factors.size(); ++s)
    if (around.layers[s].name == kSkyLayer)
      of_sky = factors[s];
    else if (around.layers[s].energy.emitted * factors[s] > 0)
      return {};
  return of_sky > 0 ? std::optional(*around.daylight_reference * of_sky) : std::nullopt;
}

void mix_daylight(Arrays& arrays, const std::optional<double>& reference) {
  const auto at = arrays.find("daylight_factor");
  if (at == arrays.end()) return;
  if (!reference) {
    arrays.erase(at);
    return;
  }
  const std::vector<float>& lux = arrays.at("illuminance").value;
  for (std::size_t i = 0; i < lux.size(); ++i) at->second.value[i] = static_cast<float>(100 * lux[i] / *reference);
}

void mix_sky(SceneAround& around, std::span<const double> factors) {
  if (around.sky.empty()) return;
  std::vector<double>& all = around.sky.radiance.value;
  std::ranges::fill(all, 0);
  for (std::size_t s = 0; s < factors.size(); ++s) {
    std::vector<double>& own = around.layers[s].sky.radiance.value;
    scale(own, factors[s]);
    for (std::size_t k = 0; k < own.size(); ++k) all[k] += own[k];
  }
}

/// By the layer of luminaires of that group; 1 where there is none.
double factor_of_group(const std::vector<ShownLayer>& layers, std::span<const double> factors,
                       const std::string& group) {
  const auto at = std::ranges::find(layers, group.empty() ? kLuminairesLayer : group, &ShownLayer::name);
  return at == layers.end() ? 1 : factors[static_cast<std::size_t>(at - layers.begin())];
}

/// Sums over the layers, points x channels.
Field sum_of_lanes(const Field& lanes, int channels) {
  Field sum(lanes.size(), channels);
  for (std::size_t i = 0; i < sum.size(); ++i)
    for (int l = 0; l < lanes.channels; ++l) sum.at(i, l % channels) += lanes.at(i, l);
  return sum;
}

void mix_sensors(MeasuredSensors& sensors, int channels, std::span<const double> factors) {
  Field& lanes = sensors.layers;
  for (std::size_t i = 0; i < lanes.size(); ++i)
    for (int l = 0; l < lanes.channels; ++l) lanes.at(i, l) *= factors[static_cast<std::size_t>(l / channels)];
  const Field E = sum_of_lanes(lanes, channels);
  for (std::size_t i = 0; i < E.size(); ++i) sensors.illuminance[i] = photometric(E[i]);
}

}  // namespace

std::vector<double> factors_of(const WrittenResult& result, std::span<const LayerFactor> set) {
  const std::vector<ShownLayer>& layers = result.around.layers;
  if (layers.empty())
    throw InputError(text(result.file, ": has no layers to mix; solve the scene again with --layers."));
  std::vector<double> factors(layers.size(), 1);
  for (const auto& [name, factor] : set) {
    const auto at = std::ranges::find(layers, name, &ShownLayer::name);
    if (at == layers.end()) {
      std::vector<std::string_view> known;
      for (const ShownLayer& layer : layers) known.push_back(layer.name);
      const std::string near = suggestion(name, known);
      throw InputError(
          text(result.file, ": there is no layer '", quotable(name), "'; ", near, near.ends_with('?') ? "" : "."));
    }
    if (!(factor >= 0 && factor <= kMostFactor))
      throw InputError(text("layer '", quotable(name), "': factor = ", factor, " is outside [0, ", kMostFactor,
                            "]; 1 is the light as the result has it."));
    factors[static_cast<std::size_t>(at - layers.begin())] = factor;
  }
  return factors;
}

std::string factor_words(std::span<const LayerFactor> factors, int digits) {
  return some_of(factors, factors.size(),
                 [&](const LayerFactor& f) { return text("'", quotable(f.layer), "'=", rounded(f.factor, digits)); });
}

void mix_layers(WrittenResult& result, std::span<const double> factors) {
  if (is_as_before(factors)) return;
  SceneAround& around = result.around;
  const std::optional<double> reference = reference_of(around, factors);
  for (Arrays* arrays : {&result.of_points, &result.of_cells}) {
    mix_arrays(*arrays, around.layers, factors);
    mix_daylight(*arrays, reference);
  }
  around.daylight_reference = reference;
  mix_sky(around, factors);
  for (MeasuredSensors& sensors : around.sensors) mix_sensors(sensors, result.channels(), factors);
  for (ShownLuminaire& luminaire : around.luminaires)
    luminaire.luminous_flux *= factor_of_group(around.layers, factors, luminaire.group);
  for (std::size_t s = 0; s < factors.size(); ++s) {
    ShownLayer& layer = around.layers[s];
    layer.factor *= factors[s];
    for (double* flux : {&layer.energy.emitted, &layer.energy.absorbed, &layer.energy.escaped}) *flux *= factors[s];
  }
}

RunReport report_of_mix(RunReport before, const WrittenResult& mixed, std::span<const double> factors) {
  RunReport report = std::move(before);
  const SceneAround& around = mixed.around;
  report.layers = around.layers;
  report.sensors.clear();
  for (const MeasuredSensors& s : around.sensors)
    if (!s.illuminance.empty()) report.sensors.push_back(summary_of(s.set, s.illuminance, around.daylight_reference));
  if (is_as_before(factors)) return report;
  report.energy = {};
  for (const ShownLayer& layer : around.layers) report.energy += layer.energy;
  for (RunReport::Luminaires& row : report.luminaires)
    row.luminous_flux *= factor_of_group(around.layers, factors, row.group);
  report.error.reset(), report.error_sensors.reset(), report.worst_space.reset();
  report.error_spaces.clear(), report.error_sets.clear();
  return report;
}

SensorLight sensor_light(const WrittenResult& result) {
  SensorLight light;
  light.layers.channels = static_cast<int>(result.around.layers.size()) * result.channels();
  for (const MeasuredSensors& s : result.around.sensors)
    light.layers.value.insert(light.layers.value.end(), s.layers.value.begin(), s.layers.value.end());
  light.E = sum_of_lanes(light.layers, result.channels());
  return light;
}

}  // namespace clerestory
