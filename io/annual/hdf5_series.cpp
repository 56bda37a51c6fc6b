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
             const std::vector<SeriesPoints>& sets)
      : Hdf5Series(hdf5, destination, hours.size()) {  // from here on the destructor closes what is open
    check(hdf5_.create(file_.name_to_open().c_str(), id_));
    check(hdf5_.write_ints(id_, "hour", hours.data(), hours.size()));
    for (const SeriesPoints& set : sets) {
      const std::size_t n = set.points.size();
      check(hdf5_.make_group(id_, set.name.c_str()));
      check(hdf5_.write_doubles(id_, (set.name + "/position").c_str(),
                                coordinates_of(set.points, &SensorPoint::position).data(), n, 3));
      check(hdf5_.write_doubles(id_, (set.name + "/normal").c_str(),
                                coordinates_of(set.points, &SensorPoint::normal).data(), n, 3));
      Set& own = sets_.emplace_back();
      own.missing = n;
      check(hdf5_.make_floats(id_, (set.name + "/total").c_str(), "lx", n, hours_, own.total));
      check(hdf5_.make_floats(id_, (set.name + "/direct").c_str(), "lx", n, hours_, own.direct));
    }
  }
  ~Hdf5Series() override { close(); }
  Hdf5Series(const Hdf5Series&) = delete;
  Hdf5Series& operator=(const Hdf5Series&) = delete;

  void add(std::size_t set, std::span<const float> total, std::span<const float> direct) override {
    Set& own = sets_[set];
    const std::size_t n = total.size() / hours_;
    CLERESTORY_ASSERT(direct.size(), ==, total.size());
    CLERESTORY_ASSERT(n, <=, own.missing);
    check(hdf5_.write_rows(own.total, own.done, n, hours_, total.data()));
    check(hdf5_.write_rows(own.direct, own.done, n, hours_, direct.data()));
    own.done += n;
    own.missing -= n;
  }
  void commit() override {
    for ([[maybe_unused]] const Set& set : sets_) CLERESTORY_ASSERT(set.missing, ==, std::size_t{0});
    check(close());
    file_.commit();
  }

 private:
  Hdf5Series(const Hdf5Functions& hdf5, const std::filesystem::path& destination, std::size_t hours)
      : hdf5_(hdf5), hours_(hours), file_(destination) {}

  struct Set {
    Hdf5Id total = -1, direct = -1;
    std::size_t done = 0, missing = 0;  ///< rows
  };

  void check(const char* why) const {
    if (why) file_.refuse(text("HDF5 says '", quotable(why, 200), "'"));
  }
  const char* close() {
    const char* why = nullptr;
    const auto note = [&](const char* reason) {
      if (!why) why = reason;
    };
    for (Set& set : sets_)
      for (Hdf5Id* data : {&set.total, &set.direct})
        if (*data >= 0) note(hdf5_.close_data(*data)), *data = -1;
    if (id_ >= 0) note(hdf5_.close_file(id_)), id_ = -1;
    return why;
  }

  const Hdf5Functions& hdf5_;
  std::size_t hours_;
  AtomicFile file_;
  Hdf5Id id_ = -1;
  std::vector<Set> sets_;
};

}  // namespace

std::unique_ptr<HourSeries> make_hdf5_series(const std::filesystem::path& file, std::span<const int> hours,
                                             const std::vector<SeriesPoints>& sets) {
  using Get = const Hdf5Functions*();
  const auto get = reinterpret_cast<Get*>(module_function(kHdf5Module, kHdf5Symbol));
  if (!get) {
    throw InputError(text(file.string(), ": ", kHdf5Module,
                          " or what it needs is not installed; install it, or name a ",
                          "folder, which gets the same series as NumPy's files"));
  }
  return std::make_unique<Hdf5Series>(*get(), file, hours, sets);
}

}  // namespace clerestory
