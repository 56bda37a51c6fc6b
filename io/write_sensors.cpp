#include "io/write_sensors.h"

#include <charconv>
#include <string>

#include "io/atomic_file.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

void append(std::string& row, double value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  row.append(digits, end);
}

std::string quoted_where_needed(const std::string& name) {
  return name.find(',') == std::string::npos ? name : '"' + name + '"';  // names of layers have no quotation marks
}

/// illuminance,irradiance_0,... of the lanes from `first` on.
void append_light(std::string& row, const Field& E, std::size_t i, int first, int channels) {
  const auto at = [&](int k) { return E.at(i, first + k); };
  append(row, photometric(channels == 1 ? Spectrum(at(0)) : Spectrum(at(0), at(1), at(2))));
  for (int k = 0; k < channels; ++k) {
    row += ',';
    append(row, at(k));
  }
}

}  // namespace

void write_sensors(AtomicFile& file, std::span<const SensorPoint> points, const Field& E, const Field& std_error,
                   const SensorLayers& layers) {
  std::string text = "x,y,z,nx,ny,nz,illuminance";
  for (int k = 0; k < E.channels; ++k) text += ",irradiance_" + std::to_string(k);
  const bool has_error = !std_error.value.empty();
  if (has_error) text += ",std_error";
  for (const std::string& name : layers.names) {
    text += ',' + quoted_where_needed("illuminance:" + name);
    for (int k = 0; k < E.channels; ++k)
      text += ',' + quoted_where_needed("irradiance_" + std::to_string(k) + ":" + name);
  }
  text += '\n';
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [p, n] = points[i];
    for (const double value : {p.x, p.y, p.z, n.x, n.y, n.z}) {
      append(text, value);
      text += ',';
    }
    append_light(text, E, i, 0, E.channels);
    if (has_error) {
      text += ',';
      append(text, photometric(std_error[i]));
    }
    for (std::size_t s = 0; s < layers.names.size(); ++s) {
      text += ',';
      append_light(text, layers.E, i, static_cast<int>(s) * E.channels, E.channels);
    }
    text += '\n';
  }
  file.write(text);
}

void write_sensors(const std::filesystem::path& file, std::span<const SensorPoint> points, const Field& E,
                   const Field& std_error) {
  AtomicFile whole(file);
  write_sensors(whole, points, E, std_error);
  whole.commit();
}

void write_sensor_figures(AtomicFile& file, std::span<const SensorPoint> points, std::span<const std::string> names,
                          std::span<const double> value) {
  std::string text = "x,y,z,nx,ny,nz";
  for (const std::string& name : names) text += ',' + name;
  text += '\n';
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [p, n] = points[i];
    append(text, p.x);
    for (const double coordinate : {p.y, p.z, n.x, n.y, n.z}) append(text += ',', coordinate);
    for (const double figure : value.subspan(i * names.size(), names.size())) append(text += ',', figure);
    text += '\n';
  }
  file.write(text);
}

}  // namespace clerestory
