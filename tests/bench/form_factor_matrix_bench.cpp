// Form factors: cost of the exact pair, full matrices of closed rooms with two blocks, and packet visibility against
// bare rtcOccluded16 on the same segments. Prints rows "what,value,unit,bar".

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <vector>

#include <embree3/rtcore.h>

#include "solver/form_factors/polygon_to_polygon.h"
#include "solver/methods/form_factor_matrix.h"
#include "solver/model/random_stream.h"
#include "tests/support/room_with_blocks.h"

using namespace clerestory;

namespace {

struct Clock {
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  std::clock_t cpu_start = std::clock();
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); }
  double cpu_seconds() const { return static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC; }
};

void row(const char* what, double value, const char* unit, const char* bar = "") {
  std::printf("%s,%.4g,%s,%s\n", what, value, unit, bar);
  std::fflush(stdout);
}

void exact_pairs() {
  const std::array<Vec3, 3> a{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0.2, 0.9, 0}};
  const std::array<Vec3, 3> touching{Vec3{0, 0, 0}, Vec3{0.3, -0.2, 0.8}, Vec3{1, 0, 0}};
  const std::array<Vec3, 3> skew{Vec3{0.1, 0.2, 0.7}, Vec3{0.4, 1.1, 0.9}, Vec3{1.2, 0.3, 0.8}};
  const auto cost = [&](const std::array<Vec3, 3>& b) {
    constexpr int kRuns = 20'000;
    double sum = 0;
    const Clock clock;
    for (int k = 0; k < kRuns; ++k) sum += exchange_area(a, b);
    return sum >= 0 ? clock.cpu_seconds() / kRuns * 1e6 : 0;
  };
  row("polygon_to_polygon touching triangles", cost(touching), "us");
  row("polygon_to_polygon near skew triangles", cost(skew), "us");
}

void matrix(const char* name, const test::RoomWithBlocks& room, const char* bar) {
  const PatchSet patches = room.build();
  const RayScene rays(patches);
  const Clock clock;
  const FormFactorMatrix F = form_factor_matrix(patches, rays);
  const double wall = clock.seconds(), cpu = clock.cpu_seconds();
  double worst = 0;
  for (const double sum : F.raw_row_sum) worst = std::max(worst, std::abs(sum - 1));
  row((std::string(name) + " wall").c_str(), wall, "s", bar);
  row((std::string(name) + " cpu").c_str(), cpu, "s");
  row((std::string(name) + " worst raw row error").c_str(), worst, "1", "<= 1e-3");
  row((std::string(name) + " memory / matrix").c_str(),
      static_cast<double>(form_factor_bytes(F.n)) / (static_cast<double>(F.n * F.n) * sizeof(float)), "1", "<= 1.2");
}

/// The patches once more as a plain Embree scene, without anything of ours around it.
RTCScene bare_scene(RTCDevice device, const PatchSet& patches) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                             3 * sizeof(float), patches.vertices.size()));
  auto* index = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                               3 * sizeof(unsigned), patches.triangle_count()));
  for (const Vec3& v : patches.vertices)
    for (int axis = 0; axis < 3; ++axis) *vertex++ = static_cast<float>(v[axis]);
  for (const auto& corners : patches.corners)
    for (const VertexId v : corners) *index++ = v.value;
  rtcCommitGeometry(geometry);
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  return scene;
}

void packet_visibility() {
  const PatchSet patches = test::room_of_4860_patches().build();
  const RayScene rays(patches);
  std::vector<SegmentPacket> packets(20'000);
  RandomStream random(1);
  for (SegmentPacket& packet : packets) {
    const auto pick = [&] {
      return PatchId{static_cast<std::size_t>(random.uniform() * static_cast<double>(patches.patch_count()))};
    };
    const PatchId i = pick(), j = pick();
    const auto p = patches.corner_positions(i), q = patches.corner_positions(j);
    for (int k = 0; k < 16; ++k) {
      const double a = random.uniform(), b = random.uniform() * (1 - a), c = random.uniform(),
                   d = random.uniform() * (1 - c);
      packet.set(k, p[0] * (1 - a - b) + p[1] * a + p[2] * b + patches.normal[i] * rays.lift(),
                 q[0] * (1 - c - d) + q[1] * c + q[2] * d + patches.normal[j] * rays.lift());
    }
  }
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = bare_scene(device, patches);
  double ours = 1e30, bare = 1e30;
  unsigned long long seen = 0, seen_bare = 0;
  for (int repeat = 0; repeat < 5; ++repeat) {
    const Clock clock;
    seen = 0;
    for (const SegmentPacket& s : packets) seen += static_cast<unsigned>(__builtin_popcount(rays.visible16(s)));
    ours = std::min(ours, clock.cpu_seconds());
    const Clock bare_clock;
    seen_bare = 0;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    alignas(64) int valid[16];
    std::fill(std::begin(valid), std::end(valid), -1);
    for (const SegmentPacket& s : packets) {
      RTCRay16 r;
      for (std::size_t k = 0; k < 16; ++k) {
        r.org_x[k] = s.from_x[k], r.org_y[k] = s.from_y[k], r.org_z[k] = s.from_z[k];
        r.dir_x[k] = s.to_x[k] - s.from_x[k], r.dir_y[k] = s.to_y[k] - s.from_y[k],
        r.dir_z[k] = s.to_z[k] - s.from_z[k];
        r.tnear[k] = 0, r.tfar[k] = 1, r.time[k] = 0, r.mask[k] = ~0u, r.id[k] = 0, r.flags[k] = 0;
      }
      rtcOccluded16(valid, scene, &context, &r);
      for (std::size_t k = 0; k < 16; ++k) seen_bare += r.tfar[k] >= 0;
    }
    bare = std::min(bare, bare_clock.cpu_seconds());
  }
  rtcReleaseScene(scene);
  rtcReleaseDevice(device);
  const double count = 16.0 * static_cast<double>(packets.size());
  row("packet visibility", count / ours / 1e6, "million rays/s and core");
  row("bare rtcOccluded16", count / bare / 1e6, "million rays/s and core");
  row("packet visibility / bare", bare / ours, "1", ">= 0.6");
  if (seen != seen_bare) std::printf("note: %llu against %llu visible\n", seen, seen_bare);
}

}  // namespace

int main() {
  std::printf("what,value,unit,bar\n");
  exact_pairs();
  matrix("matrix 2160 patches", test::room_of_2160_patches(), "<= 3 s");
  matrix("matrix 4860 patches", test::room_of_4860_patches(), "<= 15 s");
  packet_visibility();
}
