#pragma once
// A result in layers, lit anew: each layer times a factor. No rays, no files.

#include <span>
#include <string>
#include <vector>

#include "io/run_report.h"
#include "solver/model/channels.h"
#include "solver/model/written_result.h"

namespace clerestory {

inline constexpr double kMostFactor = 1000;  ///< on a layer, as on a luminaire in a scene file

struct LayerFactor {
  std::string layer;
  double factor = 1;  ///< [1], 0 .. kMostFactor; 1: as the result has it
};

/// Factors by layer of the result, in its order; 1 for those that are not named.
///
/// set     a layer at most once.
/// throws  InputError when the result has no layers, or not that one (with the nearest name), and when a factor is
///         outside [0, kMostFactor].
std::vector<double> factors_of(const WrittenResult& result, std::span<const LayerFactor> set);

/// "'windows'=0.2000, 'middle'=0.6000": as --set takes them.
std::string factor_words(std::span<const LayerFactor> factors, int digits);

/// Scales the layers, with all that belongs to them (energy, sky, luminaires, sensors), and makes the light their sum:
///   E = sum f_s E_s,   B = sum f_s B_s, which is B E / E_before where surfaces only reflect.
/// Daylight factors stay where the sky is the only light that is left, of the sky as it is now; else they go.
/// Layers end as they were scaled, so that mixing again starts from here.
///
/// factors  one a layer, see factors_of().
void mix_layers(WrittenResult& result, std::span<const double> factors);

/// The report of the mixed result: energy, luminaires, sensors and layers of now; no error, unless all factors are 1,
/// for it was measured of the light as it was.
///
/// before  the report of the result that was mixed.
RunReport report_of_mix(RunReport before, const WrittenResult& mixed, std::span<const double> factors);

/// What sensors of all sets receive of each layer, points x lanes [W/m2], and together.
struct SensorLight {
  Field layers, E;
};
SensorLight sensor_light(const WrittenResult& result);

}  // namespace clerestory
