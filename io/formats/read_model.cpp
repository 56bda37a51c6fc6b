#include "io/formats/assimp_model.h"
#include "io/formats/model.h"
#include "io/input_file.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {

namespace {

/// A reader that does not take long enough to be stopped.
template <Model (*Read)(const std::filesystem::path&)>
Model at_once(const std::filesystem::path& file, const ShouldStop&) {
  return Read(file);
}

struct Format {
  std::string_view extension;
  Model (*read)(const std::filesystem::path&, const ShouldStop&);
};
constexpr Format kFormats[] = {
    {".obj", at_once<read_obj>},         {".gltf", at_once<read_gltf>},       {".glb", at_once<read_gltf>},
    {".ply", at_once<read_ply>},         {".stl", at_once<read_stl>},         {".off", at_once<read_off>},
    {".dae", at_once<read_with_assimp>}, {".fbx", at_once<read_with_assimp>}, {".ifc", read_ifc},
};

}  // namespace

Model read_model(const std::filesystem::path& file, const ShouldStop& should_stop) {
  const std::string extension = to_lower(file.extension().string());
  std::string known;
  for (const Format& format : kFormats) {
    if (extension == format.extension) return format.read(file, should_stop);
    known += text(known.empty() ? "" : " ", format.extension);
  }
  throw InputError(text(short_name(file), ": '", quotable(extension),
                        "' is not the extension of a scene or model that is ", "read; known are .json ", known));
}

}  // namespace clerestory
