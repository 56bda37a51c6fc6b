#pragma once
// Results of several times as one series, for ParaView.

#include <span>
#include <string>

#include "io/atomic_file.h"

namespace clerestory {

/// The result of one time.
struct FileOfTime {
  double hours = 0;  ///< ParaView's time
  std::string file;  ///< relative to the series
};

/// A .pvd file: XML that names the results of all times.
/// throws  InputError when the file cannot be written.
void write_series(AtomicFile& file, std::span<const FileOfTime> times);

}  // namespace clerestory
