#include "io/write_series.h"

#include "io/text.h"

namespace clerestory {

void write_series(AtomicFile& file, std::span<const FileOfTime> times) {
  file.write("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n");
  for (const FileOfTime& time : times)
    file.write(text("    <DataSet timestep=\"", time.hours, "\" part=\"0\" file=\"", xml_text(time.file), "\"/>\n"));
  file.write("  </Collection>\n</VTKFile>\n");
}

}  // namespace clerestory
