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
  NpySeries(const std::filesystem::path& folder, std::span<const int> hours, const std::vector<SeriesPoints>& sets) {
    make_folder(folder);
    write_npy(files_.open(folder / "hour.npy"), hours);
    for (const SeriesPoints& set : sets) {
      const std::filesystem::path own = folder / set.name;
      make_folder(own);
      write_npy(files_.open(own / "position.npy"), coordinates_of(set.points, &SensorPoint::position), 3);
      write_npy(files_.open(own / "normal.npy"), coordinates_of(set.points, &SensorPoint::normal), 3);
      total_.emplace_back(files_.open(own / "total.npy"), set.points.size(), hours.size());
      direct_.emplace_back(files_.open(own / "direct.npy"), set.points.size(), hours.size());
    }
  }
  void add(std::size_t set, std::span<const float> total, std::span<const float> direct) override {
    total_[set].add(total);
    direct_[set].add(direct);
  }
  void commit() override {
    for (const std::vector<NpyRows>* arrays : {&total_, &direct_})
      for (const NpyRows& rows : *arrays) rows.end();
    files_.commit();
  }

 private:
  Outputs files_;
  std::vector<NpyRows> total_, direct_;  ///< by set
};

}  // namespace

std::vector<double> coordinates_of(std::span<const SensorPoint> points, Vec3 SensorPoint::*of) {
  std::vector<double> values;
  values.reserve(3 * points.size());
  for (const SensorPoint& point : points) values.insert(values.end(), {(point.*of).x, (point.*of).y, (point.*of).z});
  return values;
}

std::unique_ptr<HourSeries> make_hour_series(const std::filesystem::path& destination, std::span<const int> hours,
                                             const std::vector<SeriesPoints>& sets) {
  const std::string extension = to_lower(destination.extension().string());
  if (extension == ".h5" || extension == ".hdf5") return make_hdf5_series(destination, hours, sets);
  return std::make_unique<NpySeries>(destination, hours, sets);
}

std::size_t bytes_of_series(std::size_t hours, const std::vector<SeriesPoints>& sets) {
  std::size_t points = 0;
  for (const SeriesPoints& set : sets) points += set.points.size();
  return points * (2 * hours * sizeof(float) + 6 * sizeof(double));
}

}  // namespace clerestory
