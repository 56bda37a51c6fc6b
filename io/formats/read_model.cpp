#include "io/formats/model.h"
#include "io/input_file.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {

Model read_model(const std::filesystem::path& file) {
  const std::string extension = to_lower(file.extension().string());
  if (extension == ".obj") return read_obj(file);
  throw InputError(text(short_name(file), ": '", quotable(extension), "' is not a model format; known are .obj"));
}

}  // namespace clerestory
