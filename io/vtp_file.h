#pragma once
// What all .vtp files of ours have in common. For .cpp files of io/ only: VTK shows.

#include <cstddef>
#include <vector>

#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>

#include "io/atomic_file.h"
#include "solver/model/vec.h"

class vtkPolyData;

namespace clerestory {

inline vtkIdType id(std::size_t i) { return static_cast<vtkIdType>(i); }

/// The last door before the file: a NaN here is our own mistake and must not reach a user's picture.
float to_float(double value, const char* array, std::size_t i);

/// An array of n floats, value(i) each.
template <class Value>
void add_values(vtkFieldData* to, const char* name, std::size_t n, const Value& value) {
  vtkNew<vtkFloatArray> array;
  array->SetName(name);
  array->SetNumberOfTuples(id(n));
  for (std::size_t i = 0; i < n; ++i) array->SetValue(id(i), to_float(value(i), name, i));
  to->AddArray(array);
}

/// Points of the scene's frame.
void set_points(vtkPolyData* data, const std::vector<Vec3>& local, const Vec3& origin);

/// How the numbers of a file are packed. Plain ones are a fifth larger, and written four times as fast.
enum class Packing { zlib, plain };

/// XML with the data inline in base64. Equal data give equal bytes.
///
/// throws  InputError when the file cannot be written.
void write_vtp(AtomicFile& file, vtkPolyData* data, Packing packing = Packing::zlib);

}  // namespace clerestory
