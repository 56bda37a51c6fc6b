#pragma once
// What the module that HDF5 is behind offers: plain functions, none of which throws. Each says why it failed, as HDF5
// or the system puts it, or nothing.

#include <cstddef>
#include <cstdint>

namespace clerestory {

inline constexpr const char* kHdf5Module = "clerestory_hdf5.so";

using Hdf5Id = std::int64_t;

struct Hdf5Functions {
  /// A new file in the place of what has that name.
  const char* (*create)(const char* name, Hdf5Id& file);
  /// A whole array of ints, of one dimension.
  const char* (*write_ints)(Hdf5Id file, const char* name, const int* values, std::size_t n);
  /// A group.
  const char* (*make_group)(Hdf5Id file, const char* name);
  /// A whole array of doubles, rows x columns.
  const char* (*write_doubles)(Hdf5Id file, const char* name, const double* values, std::size_t rows,
                               std::size_t columns);
  /// An array of floats to be filled, rows x columns, with its unit as an attribute.
  const char* (*make_floats)(Hdf5Id file, const char* name, const char* unit, std::size_t rows, std::size_t columns,
                             Hdf5Id& data);
  /// n rows of it from row `first` on.
  const char* (*write_rows)(Hdf5Id data, std::size_t first, std::size_t n, std::size_t columns, const float* values);
  const char* (*close_data)(Hdf5Id data);
  const char* (*close_file)(Hdf5Id file);
};

/// The symbol of the module that gives them: const Hdf5Functions* ().
inline constexpr const char* kHdf5Symbol = "clerestory_hdf5_functions";

}  // namespace clerestory
