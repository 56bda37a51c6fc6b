#include "io/formats/assimp_model.h"
#include "io/formats/model.h"
#include "io/input_file.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {

namespace {

struct Format {
  std::string_view extension;
  Model (*read)(const std::filesystem::path&);
};
constexpr Format kFormats[] = {
    {".obj", read_obj}, {".gltf", read_gltf},       {".glb", read_gltf},        {".ply", read_ply}, {".stl", read_stl},
    {".off", read_off}, {".dae", read_with_assimp}, {".fbx", read_with_assimp}, {".ifc", read_ifc},
};

}  // namespace

Model read_model(const std::filesystem::path& file) {
  const std::string extension = to_lower(file.extension().string());
  std::string known;
  for (const Format& format : kFormats) {
    if (extension == format.extension) return format.read(file);
    known += text(known.empty() ? "" : " ", format.extension);
  }
  throw InputError(text(short_name(file), ": '", quotable(extension),
                        "' is not the extension of a scene or model that is ", "read; known are .json ", known));
}

}  // namespace clerestory
