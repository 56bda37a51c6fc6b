#pragma once
// A room with all that light can do: several groups of lamps, sky and sun through glass and through a hole, a glowing
// panel, a diffuser, a mirror.

#include "solver/illumination/place_lights.h"
#include "solver/illumination/problem.h"
#include "solver/visibility/ray_scene.h"
#include "tests/support/luminaires.h"
#include "tests/support/room_with_blocks.h"
#include "tests/support/unjoined_lightmap.h"

namespace clerestory::test {

inline PatchSet room_of_many_lights(int channels) {
  PatchBuilder b(0.5);
  b.rectangle({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, 4, 3);    // floor
  b.rectangle({0, 0, 2.5}, {0, 3, 0}, {4, 0, 0}, 3, 4);  // ceiling
  b.rectangle({0, 3, 0}, {4, 0, 0}, {0, 0, 2.5}, 4, 2);  // far wall
  b.rectangle({0, 0, 0}, {0, 3, 0}, {0, 0, 2.5}, 3, 2);  // wall at x = 0
  b.rectangle({4, 0, 0}, {0, 0, 2.5}, {0, 3, 0}, 2, 3);  // wall at x = 4
  b.rectangle({0, 0, 0}, {0, 0, 1}, {4, 0, 0}, 1, 4);    // below the windows
  b.rectangle({0, 0, 2}, {0, 0, 0.5}, {4, 0, 0}, 1, 4);  // above them
  b.rectangle({1.8, 0, 1}, {0, 0, 1}, {0.4, 0, 0});      // between them; the right one has no pane
  b.box({2.4, 1.4, 0.3}, {0.5, 0.1, 0}, {-0.1, 0.5, 0}, {0, 0, 0.6}, {1, 1, 1}, false);
  for (int k = 0; k < 12; ++k)  // small things that receive as one
    b.box({0.9 + 0.02 * (k % 4), 1.9 + 0.02 * (k / 4), 0.5}, {0.006, 0, 0}, {0, 0.006, 0}, {0, 0, 0.006}, {1, 1, 1},
          false);
  b.material(0.3, 40).rectangle({1, 2.99, 1.2}, {0.8, 0, 0}, {0, 0, 0.4});  // panel on the far wall
  b.glass(0.7).rectangle({0, 0, 1}, {0, 0, 1}, {1.8, 0, 0});
  b.diffuser(0.3, 0.5).rectangle({2.2, 0.8, 1.2}, {0, 0, 0.8}, {1.2, 0, 0}, 1, 2);
  b.mirror(0.8).rectangle({0.01, 0.5, 0.5}, {0, 1, 0}, {0, 0, 1});
  PatchSet patches = b.build();
  if (channels == 1) return patches;
  for (Material& m : patches.materials) m.reflectance[2] *= 0.5, m.transmittance[0] *= 0.9, m.exitance[1] *= 0.7;
  std::vector<bool> wanted;
  for (const auto& sides : patches.side_patch)
    for (const PatchId p : sides) wanted.push_back(p.valid());
  patches.channels = channels;
  make_patches(patches, wanted);
  return patches;
}

struct ManyLights {
  PatchSet patches;
  RayScene rays{patches};
  Lights lights;
  VertexLightmap map = unjoined_lightmap(patches);
  Problem problem{patches, rays, lights};

  static LightSpec spec(int channels) {
    const Spectrum colour = channels == 1 ? Spectrum(1.0) : Spectrum(1, 0.8, 0.5);
    LightSpec light;
    const auto lamp = [&](const Vec3& at, double power, const char* group) {
      light.luminaires.push_back({"lamp", at, group, PointLuminaire{power * colour}});
    };
    lamp({1, 1, 2.2}, 20, "left"), lamp({1, 2, 2.2}, 30, "left"), lamp({3, 1, 2.2}, 40, "right");
    lamp({3, 2, 2.2}, 10, "right"), lamp({2, 1.5, 2.3}, 25, "middle"), lamp({2, 2.5, 2.3}, 5, "middle");
    light.sky = Sky{.model = SkyModel::cie_overcast, .horizontal_irradiance = 60 * colour};
    light.suns = {{normalized(Vec3{0.3, -1, 0.7}), 300 * colour}};
    return light;
  }
  explicit ManyLights(int channels)
      : patches(room_of_many_lights(channels)), lights(place_lights(spec(channels), patches, rays)) {}
};

}  // namespace clerestory::test
