#include <bit>
#include <cstring>

#include "io/bake/baked_files.h"
#include "io/text.h"
#include "solver/model/bake_points.h"
#include "solver/model/exposure.h"

namespace clerestory {
namespace {

static_assert(std::endian::native == std::endian::little, "the file says that its numbers are little-endian");

template <class Number>
void append(std::string& bytes, Number value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

void append(std::string& bytes, const Vec3& v) {
  for (int k = 0; k < 3; ++k) append(bytes, static_cast<float>(v[k]));
}

}  // namespace

void write_baked_ply(AtomicFile& file, const BakedMesh& mesh, double exposure) {
  const Vec3 origin = near_origin(mesh.position);
  std::ostringstream head;
  head.precision(17);
  head << "ply\nformat binary_little_endian 1.0\ncomment Clerestory: illuminance in lx, irradiance in W/m2, metres\n"
       << "comment exposure " << exposure << "\n";
  if (origin != Vec3{}) head << "comment origin " << origin.x << " " << origin.y << " " << origin.z << "\n";
  head << "element vertex " << mesh.position.size() << "\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) head << "property float " << name << "\n";
  for (const char* name : {"red", "green", "blue"}) head << "property uchar " << name << "\n";
  head << "property float illuminance\n";
  for (int k = 0; k < mesh.E.channels; ++k) head << "property float irradiance_" << k << "\n";
  head << "element face " << mesh.triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";

  constexpr std::size_t kEnough = 1 << 20;
  std::string bytes = head.str();
  const auto flush = [&](std::size_t enough) {
    if (bytes.size() < enough) return;
    file.write(bytes);
    bytes.clear();
  };
  for (std::size_t i = 0; i < mesh.position.size(); ++i) {
    append(bytes, mesh.position[i] - origin);
    append(bytes, mesh.normal[i]);
    const Spectrum shown = mesh.shown[i];
    for (int k = 0; k < 3; ++k) append(bytes, srgb_byte(shown[k] * exposure));
    append(bytes, mesh.illuminance[i]);
    for (int k = 0; k < mesh.E.channels; ++k) append(bytes, static_cast<float>(mesh.E.at(i, k)));
    flush(kEnough);
  }
  for (const auto& corners : mesh.triangles) {
    append(bytes, std::uint8_t{3});
    for (const std::uint32_t corner : corners) append(bytes, corner);
    flush(kEnough);
  }
  flush(1);
}

}  // namespace clerestory
