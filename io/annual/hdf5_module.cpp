#include "io/annual/hdf5_module.h"

#include <array>
#include <string>
#include <string_view>

#include <hdf5.h>

namespace {

using clerestory::Hdf5Id;

std::string why;  ///< of the last failure; HDF5 is used by one thread at a time

/// What is told of an error by the function that met it: the last of the stack.
herr_t note_reason(unsigned depth, const H5E_error2_t* error, void*) {
  if (depth == 0) why = error->desc;
  return 0;
}

/// "file write failed: time = ..., errno = 28, error message = 'No space left on device', buf = ..." is for those who
/// wrote it; what the system said is for all.
std::string what_the_system_said(const std::string& reason) {
  constexpr std::string_view kMark = "error message = '";
  const std::size_t mark = reason.find(kMark);
  if (mark == reason.npos) return reason;
  const std::size_t begin = mark + kMark.size();
  return reason.substr(begin, reason.find('\'', begin) - begin);
}

const char* failure() {
  why = "no reason is given";
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, note_reason, nullptr);
  why = what_the_system_said(why);
  return why.c_str();
}

const char* failure_unless(bool went_well) { return went_well ? nullptr : failure(); }

/// A property list or space that is closed at the end.
class Id {
 public:
  Id(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  ~Id() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Without the time of day: the same series, the same bytes.
hid_t properties_of_data() {
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_obj_track_times(properties, false);
  return properties;
}

hid_t make_data(hid_t file, const char* name, hid_t type, int rank, const hsize_t* size) {
  const Id space(H5Screate_simple(rank, size, nullptr), H5Sclose);
  const Id properties(properties_of_data(), H5Pclose);
  return H5Dcreate2(file, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT);
}

const char* write_whole(hid_t file, const char* name, hid_t stored, hid_t given, int rank, const hsize_t* size,
                        const void* values) {
  const Id data(make_data(file, name, stored, rank, size), H5Dclose);
  return failure_unless(data >= 0 && H5Dwrite(data, given, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
}

const char* create(const char* name, Hdf5Id& file) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // messages are ours to show
  const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access, false, true);  // it is locked already, by the file that waits for its name
  file = H5Fcreate(name, H5F_ACC_TRUNC, H5P_DEFAULT, access);
  return failure_unless(file >= 0);
}

const char* write_ints(Hdf5Id file, const char* name, const int* values, std::size_t n) {
  const hsize_t size = n;
  return write_whole(file, name, H5T_STD_I32LE, H5T_NATIVE_INT, 1, &size, values);
}

const char* make_group(Hdf5Id file, const char* name) {
  const Id group(H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  return failure_unless(group >= 0);
}

const char* write_doubles(Hdf5Id file, const char* name, const double* values, std::size_t rows, std::size_t columns) {
  const std::array<hsize_t, 2> size = {rows, columns};
  return write_whole(file, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 2, size.data(), values);
}

bool add_unit(hid_t data, const char* unit) {
  const Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);
  const Id space(H5Screate(H5S_SCALAR), H5Sclose);
  const Id attribute(H5Acreate2(data, "unit", type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute >= 0 && H5Awrite(attribute, type, &unit) >= 0;
}

const char* make_floats(Hdf5Id file, const char* name, const char* unit, std::size_t rows, std::size_t columns,
                        Hdf5Id& data) {
  const std::array<hsize_t, 2> size = {rows, columns};
  data = make_data(file, name, H5T_IEEE_F32LE, 2, size.data());
  return failure_unless(data >= 0 && add_unit(data, unit));
}

const char* write_rows(Hdf5Id data, std::size_t first, std::size_t n, std::size_t columns, const float* values) {
  const std::array<hsize_t, 2> begin = {first, 0}, size = {n, columns};
  const Id in_file(H5Dget_space(data), H5Sclose);
  const Id in_memory(H5Screate_simple(2, size.data(), nullptr), H5Sclose);
  return failure_unless(H5Sselect_hyperslab(in_file, H5S_SELECT_SET, begin.data(), nullptr, size.data(), nullptr) >=
                            0 &&
                        H5Dwrite(data, H5T_NATIVE_FLOAT, in_memory, in_file, H5P_DEFAULT, values) >= 0);
}

const char* close_data(Hdf5Id data) { return failure_unless(H5Dclose(data) >= 0); }
const char* close_file(Hdf5Id file) { return failure_unless(H5Fclose(file) >= 0); }

constexpr clerestory::Hdf5Functions kFunctions = {create,      write_ints, make_group, write_doubles,
                                                  make_floats, write_rows, close_data, close_file};

}  // namespace

extern "C" [[gnu::visibility("default")]] const clerestory::Hdf5Functions* clerestory_hdf5_functions() {
  return &kFunctions;
}
