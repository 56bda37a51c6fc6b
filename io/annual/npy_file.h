#pragma once
// Arrays as NumPy's .npy files hold them.

#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>

#include "io/atomic_file.h"

namespace clerestory {

/// What stands before the numbers, row after row in this machine's byte order. type: "f4", "f8", "i4".
/// Source: "NEP 1: a simple file format for NumPy arrays", version 1.0.
std::string npy_header(const char* type, std::initializer_list<std::size_t> shape);

/// A whole array, into a file that the caller commits.
void write_npy(AtomicFile& file, std::span<const int> values);
/// values  rows of `columns`.
void write_npy(AtomicFile& file, std::span<const double> values, std::size_t columns);

/// An array of floats that comes in blocks of rows, into a file that outlives this and that the caller commits.
class NpyRows {
 public:
  NpyRows(AtomicFile& file, std::size_t rows, std::size_t columns);
  /// The next rows, one after the other.
  void add(std::span<const float> values);
  /// All rows were given.
  void end() const;

 private:
  AtomicFile& file_;
  std::size_t missing_;  ///< numbers
};

}  // namespace clerestory
