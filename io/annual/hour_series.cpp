#include "io/annual/hour_series.h"

#include <vector>

#include "io/annual/hdf5_series.h"
#include "io/annual/npy_file.h"
#include "io/output_folder.h"
#include "io/text.h"

namespace clerestory {
namespace {

/// A folder of .npy files, which appear together.
class NpySeries : public HourSeries {
 public:
  NpySeries(const std::filesystem::path& folder, std::span<const int> hours, std::span<const SensorPoint> sensors)
      : own_(made(folder / "sensors")),
        total_(files_.open(own_ / "total.npy"), sensors.size(), hours.size()),
        direct_(files_.open(own_ / "direct.npy"), sensors.size(), hours.size()) {
    write_npy(files_.open(folder / "hour.npy"), hours);
    write_npy(files_.open(own_ / "position.npy"), coordinates_of(sensors, &SensorPoint::position), 3);
    write_npy(files_.open(own_ / "normal.npy"), coordinates_of(sensors, &SensorPoint::normal), 3);
  }
  void add(std::span<const float> total, std::span<const float> direct) override {
    total_.add(total);
    direct_.add(direct);
  }
  void commit() override {
    total_.end(), direct_.end();
    files_.commit();
  }

 private:
  static std::filesystem::path made(const std::filesystem::path& folder) {
    make_folder(folder);
    return folder;
  }

  std::filesystem::path own_;
  Outputs files_;
  NpyRows total_, direct_;
};

}  // namespace

std::vector<double> coordinates_of(std::span<const SensorPoint> points, Vec3 SensorPoint::*of) {
  std::vector<double> values;
  values.reserve(3 * points.size());
  for (const SensorPoint& point : points) values.insert(values.end(), {(point.*of).x, (point.*of).y, (point.*of).z});
  return values;
}

std::unique_ptr<HourSeries> make_hour_series(const std::filesystem::path& destination, std::span<const int> hours,
                                             std::span<const SensorPoint> sensors) {
  const std::string extension = to_lower(destination.extension().string());
  if (extension == ".h5" || extension == ".hdf5") return make_hdf5_series(destination, hours, sensors);
  return std::make_unique<NpySeries>(destination, hours, sensors);
}

std::size_t bytes_of_series(std::size_t hours, std::size_t sensors) {
  return sensors * (2 * hours * sizeof(float) + 6 * sizeof(double));
}

}  // namespace clerestory
