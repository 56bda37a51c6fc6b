#include "io/annual/hdf5_series.h"

#include "io/annual/hdf5_module.h"
#include "io/atomic_file.h"
#include "io/load_module.h"
#include "io/text.h"
#include "solver/model/assert.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

class Hdf5Series : public HourSeries {
 public:
  Hdf5Series(const Hdf5Functions& hdf5, const std::filesystem::path& destination, std::span<const int> hours,
             std::span<const SensorPoint> sensors)
      : Hdf5Series(hdf5, destination, hours.size()) {  // from here on the destructor closes what is open
    const std::size_t n = missing_ = sensors.size();
    check(hdf5_.create(file_.name_to_open().c_str(), id_));
    check(hdf5_.write_ints(id_, "hour", hours.data(), hours.size()));
    check(hdf5_.make_group(id_, "sensors"));
    check(hdf5_.write_doubles(id_, "sensors/position", coordinates_of(sensors, &SensorPoint::position).data(), n, 3));
    check(hdf5_.write_doubles(id_, "sensors/normal", coordinates_of(sensors, &SensorPoint::normal).data(), n, 3));
    check(hdf5_.make_floats(id_, "sensors/total", "lx", n, hours_, total_));
    check(hdf5_.make_floats(id_, "sensors/direct", "lx", n, hours_, direct_));
  }
  ~Hdf5Series() override { close(); }
  Hdf5Series(const Hdf5Series&) = delete;
  Hdf5Series& operator=(const Hdf5Series&) = delete;

  void add(std::span<const float> total, std::span<const float> direct) override {
    const std::size_t n = total.size() / hours_;
    CLERESTORY_ASSERT(direct.size(), ==, total.size());
    CLERESTORY_ASSERT(n, <=, missing_);
    check(hdf5_.write_rows(total_, done_, n, hours_, total.data()));
    check(hdf5_.write_rows(direct_, done_, n, hours_, direct.data()));
    done_ += n;
    missing_ -= n;
  }
  void commit() override {
    CLERESTORY_ASSERT(missing_, ==, std::size_t{0});
    check(close());
    file_.commit();
  }

 private:
  Hdf5Series(const Hdf5Functions& hdf5, const std::filesystem::path& destination, std::size_t hours)
      : hdf5_(hdf5), hours_(hours), file_(destination) {}

  void check(const char* why) const {
    if (why) file_.refuse(text("HDF5 says '", quotable(why, 200), "'"));
  }
  const char* close() {
    const char* why = nullptr;
    const auto note = [&](const char* reason) {
      if (!why) why = reason;
    };
    for (Hdf5Id* data : {&total_, &direct_})
      if (*data >= 0) note(hdf5_.close_data(*data)), *data = -1;
    if (id_ >= 0) note(hdf5_.close_file(id_)), id_ = -1;
    return why;
  }

  const Hdf5Functions& hdf5_;
  std::size_t hours_;
  AtomicFile file_;
  Hdf5Id id_ = -1, total_ = -1, direct_ = -1;
  std::size_t done_ = 0, missing_ = 0;  ///< rows
};

}  // namespace

std::unique_ptr<HourSeries> make_hdf5_series(const std::filesystem::path& file, std::span<const int> hours,
                                             std::span<const SensorPoint> sensors) {
  using Get = const Hdf5Functions*();
  const auto get = reinterpret_cast<Get*>(module_function(kHdf5Module, kHdf5Symbol));
  if (!get) {
    throw InputError(text(file.string(), ": ", kHdf5Module,
                          " or what it needs is not installed; install it, or name a ",
                          "folder, which gets the same series as NumPy's files"));
  }
  return std::make_unique<Hdf5Series>(*get(), file, hours, sensors);
}

}  // namespace clerestory
