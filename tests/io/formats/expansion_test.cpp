// Small files that ask for much: each is read in time and memory that go by its bytes, or refused. At these sizes what
// grows with a square takes minutes, which the time limit of the suite tells; memory is bounded here.

#include <fstream>
#include <functional>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/io/reading.h"

namespace clerestory {
namespace {

/// While it lives, asking for more than a gigabyte of address space fails with std::bad_alloc.
class OneGigabyte {
 public:
  OneGigabyte() {
    getrlimit(RLIMIT_AS, &before_);
    rlimit limit = before_;
    limit.rlim_cur = std::min<rlim_t>(before_.rlim_cur, address_space() + (1u << 30));
    setrlimit(RLIMIT_AS, &limit);
  }
  ~OneGigabyte() { setrlimit(RLIMIT_AS, &before_); }
  OneGigabyte(const OneGigabyte&) = delete;
  OneGigabyte& operator=(const OneGigabyte&) = delete;

 private:
  static rlim_t address_space() {
    std::ifstream in("/proc/self/statm");
    rlim_t pages = 0;
    in >> pages;
    return pages * 4096;
  }
  rlimit before_{};
};

std::string joined(std::size_t count, const std::function<std::string(std::size_t)>& part, const char* by = ",") {
  std::string all;
  for (std::size_t i = 0; i < count; ++i) all += (i ? by : "") + part(i);
  return all;
}
std::string number(std::size_t i) { return std::to_string(i); }

/// A triangle of a metre, and as many more as there are nodes.
struct Parts {
  std::string nodes = R"({"mesh":0})", roots = "0", accessors, primitives, buffers, views, meshes, materials = "{}";
  std::string triangle = "tri.bin";
  std::string str() const {
    return R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[)" + roots + R"(]}],"nodes":[)" + nodes +
           R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0}})" + primitives + "]}" + meshes +
           R"(],"materials":[)" + materials +
           R"(],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"})" + accessors +
           R"(],"bufferViews":[{"buffer":0,"byteLength":36})" + views + R"(],"buffers":[{"byteLength":36,"uri":")" +
           triangle + "\"}" + buffers + "]}";
  }
};

class Expansion : public ::testing::Test {
 protected:
  Expansion() {
    const float points[9] = {0, 0, 0, 1, 0, 0, 0, 0, 1};
    folder_.write("tri.bin", {reinterpret_cast<const char*>(points), sizeof(points)});
  }
  Scene read(const Parts& parts) {
    const OneGigabyte bound;
    return read_scene(folder_.write("a.gltf", parts.str()));
  }
  std::string refused(const Parts& parts) {
    const OneGigabyte bound;
    return refusal(folder_.write("a.gltf", parts.str()));
  }
  TempFolder folder_;
};

TEST_F(Expansion, AccessorsWithoutABufferViewHaveOneBudgetForTheWholeFile) {
  const auto unbacked = [](std::size_t count, std::size_t elements) {
    Parts parts;
    parts.accessors = "," + joined(count, [&](std::size_t) {
                        return R"({"componentType":5126,"type":"VEC3","count":)" + number(elements) + "}";
                      });
    parts.primitives =
        "," + joined(count, [](std::size_t i) { return R"({"attributes":{"POSITION":)" + number(i + 1) + "}}"; });
    return parts;
  };
  EXPECT_NE(refused(unbacked(1, 60'000'000)).find("accessors[1] has 60000000 elements and no bufferView"),
            std::string::npos);
  EXPECT_NE(refused(unbacked(50, 900'000)).find("accessors[2] has 900000 elements and no bufferView"),
            std::string::npos);
  EXPECT_EQ(read(unbacked(2, 3)).polygons.face_count(), 3u);
}

TEST_F(Expansion, IndicesAndSparseAccessorsWithoutABufferViewSpendTheSameBudget) {
  Parts indices;
  indices.accessors = R"(,{"componentType":5125,"type":"SCALAR","count":900000})";
  indices.primitives =
      "," + joined(60, [](std::size_t) { return std::string(R"({"attributes":{"POSITION":0},"indices":1})"); });
  EXPECT_NE(refused(indices).find("accessors[1] has 900000 elements and no bufferView"), std::string::npos);
  Parts sparse;
  sparse.views = R"(,{"buffer":0,"byteLength":4})";
  sparse.accessors = R"(,{"componentType":5126,"type":"VEC3","count":60000000,"sparse":{"count":1,
                        "indices":{"bufferView":1,"componentType":5121},"values":{"bufferView":0}}})";
  sparse.primitives = R"(,{"attributes":{"POSITION":1}})";
  EXPECT_NE(refused(sparse).find("accessors[1] has 60000000 elements"), std::string::npos);
}

TEST_F(Expansion, VerticesThatManyPrimitivesOrNodesShowCountEachTime) {
  folder_.write("many.bin", std::string(12 * 30'000, '\1'));  // vertices
  Parts parts;
  parts.triangle = "many.bin";
  parts.views = R"(,{"buffer":0,"byteLength":360000})";
  parts.accessors = R"(,{"bufferView":1,"componentType":5126,"count":30000,"type":"VEC3"})";
  parts.primitives = "," + joined(1000, [](std::size_t) { return std::string(R"({"attributes":{"POSITION":1}})"); });
  EXPECT_NE(refused(parts).find("vertices and corners, the most for that size"), std::string::npos);
  parts.primitives = R"(,{"attributes":{"POSITION":1}})";
  parts.nodes = joined(1000, [](std::size_t) { return std::string(R"({"mesh":0})"); });
  parts.roots = joined(1000, number);
  EXPECT_NE(refused(parts).find("vertices and corners, the most for that size"), std::string::npos);
}

TEST_F(Expansion, PrimitivesThatShareVerticesTakeThoseTheyUse) {
  folder_.write("many.bin", std::string(12 * 300'000, '\0') + std::string("\0\0\0\0\1\0\0\0\2\0\0\0", 12));
  Parts parts;
  parts.buffers = R"(,{"uri":"many.bin","byteLength":3600012})";
  parts.views = R"(,{"buffer":1,"byteLength":3600000},{"buffer":1,"byteOffset":3600000,"byteLength":12})";
  parts.accessors = R"(,{"bufferView":1,"componentType":5126,"count":300000,"type":"VEC3"},
                        {"bufferView":2,"componentType":5125,"count":3,"type":"SCALAR"})";
  parts.primitives =
      "," + joined(5000, [](std::size_t) { return std::string(R"({"attributes":{"POSITION":1},"indices":2})"); });
  EXPECT_EQ(read(parts).polygons.vertices.size(), 3u + 3u * 5000);
}

TEST_F(Expansion, ABufferIsReadOnceByWhateverPathAndHoweverOftenItIsNamed) {
  folder_.write("large.bin", std::string(60 << 20, '\0'));
  Parts parts;
  parts.buffers = "," + joined(60, [](std::size_t i) {
                    const char* names[] = {"large.bin", "./large.bin", "././large.bin", "%6Carge.bin"};
                    return R"({"byteLength":36,"uri":")" + std::string(names[i % 4]) + "\"}";
                  });
  EXPECT_EQ(read(parts).polygons.face_count(), 1u);
  const std::string data = "data:application/octet-stream;base64," + std::string(40'000, 'A');
  parts.buffers = "," + joined(2000, [&](std::size_t) { return R"({"byteLength":36,"uri":")" + data + "\"}"; });
  EXPECT_EQ(read(parts).polygons.face_count(), 1u);
}

TEST_F(Expansion, ALongChainOfNodesIsReadInTimeThatGoesByItsLength) {
  constexpr std::size_t kNodes = 400'000;
  Parts parts;
  parts.nodes = joined(kNodes, [](std::size_t i) { return R"({"children":[)" + number(i + 1) + "]}"; }) +
                R"(,{"mesh":0,"name":"last"})";
  EXPECT_EQ(read(parts).surfaces, std::vector<std::string>{"last"});
}

TEST_F(Expansion, ManyNodesAndMaterialsOfOneNameAreToldApartInTimeThatGoesByTheirNumber) {
  constexpr std::size_t kCount = 100'000;
  Parts parts;
  parts.materials = joined(kCount, [](std::size_t) { return std::string(R"({"name":"paint"})"); });
  parts.meshes = "," + joined(kCount, [](std::size_t i) {
                   return R"({"primitives":[{"attributes":{"POSITION":0},"material":)" + number(i) + "}]}";
                 });
  parts.nodes = joined(kCount, [](std::size_t i) { return R"({"name":"part","mesh":)" + number(i + 1) + "}"; });
  parts.roots = joined(kCount, number);
  const Scene scene = read(parts);
  EXPECT_EQ(scene.surfaces.back(), "part 100000");
  EXPECT_EQ(scene.materials.back().name, "paint (a 99999)");
}

TEST_F(Expansion, AModelMayStandInASceneManyTimes) {
  Parts parts;
  parts.nodes = joined(100, [](std::size_t i) { return R"({"name":"part )" + number(i) + R"(","mesh":0})"; });
  parts.roots = joined(100, number);
  folder_.write("a.gltf", parts.str());
  const std::string entries = joined(3000, [](std::size_t) { return std::string(R"({"file":"a.gltf"})"); });
  const Scene scene = read_scene(folder_.write("s.json", R"({"geometry":[)" + entries + "]}"));
  EXPECT_EQ(scene.surfaces.size(), 300'000u);
  EXPECT_EQ(scene.surfaces[100], "part 0 (a)");
  EXPECT_EQ(scene.surfaces.back(), "part 99 (a 2999)");
  EXPECT_EQ(scene.materials.size(), 1u);
  EXPECT_LT(scene.warnings.size(), 10u) << "what is said of a model is said once";
}

TEST_F(Expansion, AMaterialLibraryIsReadOnceHoweverOftenItIsNamed) {
  folder_.write("lib.mtl", joined(
                               20'000, [](std::size_t i) { return "newmtl m" + number(i) + "\nKd .2 .2 .2"; }, "\n"));
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl m7\nf 1 2 3\n";
  const char* names[] = {"lib.mtl", "./lib.mtl", "././lib.mtl"};
  const auto line = [&](std::size_t i) { return "mtllib " + std::string(names[i % 3]); };
  const Scene scene = read_scene(folder_.write("a.obj", joined(20'000, line, "\n") + "\n" + square));
  EXPECT_EQ(material(scene, "m7").reflectance, Spectrum(0.2));
  const auto missing = [](std::size_t i) { return "mtllib no" + number(i) + ".mtl"; };
  const Scene other = read_scene(folder_.write("b.obj", joined(20'000, missing, "\n") + "\n" + square));
  EXPECT_LT(other.warnings.size(), 100u);
  EXPECT_NE(all_warnings(other).find("b.obj: 19950 more warnings are left out"), std::string::npos);
}

TEST_F(Expansion, FilesThatAreNotThereAreLookedForInTimeThatGoesByTheirNumber) {
  for (std::size_t i = 0; i < 2'000; ++i) folder_.write("other" + number(i), "x");
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl m7\nf 1 2 3\n";
  folder_.write("lib.mtl", joined(
                               100'000,
                               [](std::size_t i) {
                                 const std::string n = number(i);
                                 return "newmtl m" + n + "\nKd .2 .2 .2\nmap_Kd " + (i % 2 ? "./" : "") + "no" + n +
                                        ".png";
                               },
                               "\n"));
  const Scene scene = read_scene(folder_.write("a.obj", "mtllib lib.mtl\n" + square));
  EXPECT_NE(all_warnings(scene).find("'m7' (no7.png is not there)"), std::string::npos);
  const auto missing = [](std::size_t i) { return "mtllib no" + number(i) + ".mtl"; };
  read_scene(folder_.write("b.obj", joined(20'000, missing, "\n") + "\n" + square));
}

}  // namespace
}  // namespace clerestory
