#include "tests/support/box_scene.h"

#include <sstream>

namespace clerestory {

std::string BoxScene::write(const TempFolder& folder) const {
  std::ostringstream obj, json;
  obj.precision(17);
  json.precision(17);
  for (int corner = 0; corner < 8; ++corner)
    obj << "v " << offset.x + (corner & 1 ? size.x : 0) << ' ' << offset.y + (corner & 2 ? size.y : 0) << ' '
        << offset.z + (corner & 4 ? size.z : 0) << '\n';
  obj << "o room\nusemtl wall\n"  // wound to the inside
      << "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n";
  json << R"({ "geometry": [{ "file": "room.obj" }], "materials": { "wall": { "reflectance": )" << rho
       << R"(, "exitance": )" << M << R"(, "sides": 1 } } })";
  folder.write("room.obj", obj.str());
  return folder.write("room.json", json.str());
}

}  // namespace clerestory
