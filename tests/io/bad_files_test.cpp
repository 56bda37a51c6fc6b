// What is no file, or not the file that its name says, whatever the format.

#include <filesystem>

#include <gtest/gtest.h>

#include "io/text.h"
#include "tests/io/reading.h"

namespace clerestory {
namespace {

constexpr std::string_view kExtensions[] = {"json", "obj", "gltf", "glb", "ply", "stl", "off", "dae", "fbx", "ifc"};

TEST(BadFiles, MissingEmptyAndFoldersAreNamed) {
  const TempFolder folder;
  for (const std::string_view extension : kExtensions) {
    const std::string name = text("a.", extension);
    EXPECT_EQ(refusal(folder / name), folder / name + ": no such file");
    EXPECT_EQ(refusal(folder.write(name, "")), folder / name + ": the file is empty");
    const std::string other = folder / text("b.", extension);
    std::filesystem::create_directory(other);
    EXPECT_EQ(refusal(other), other + ": is a folder; name a file in it");
  }
}

TEST(BadFiles, GarbageIsRefusedWithOneLine) {
  const TempFolder folder;
  std::string noise;
  for (unsigned i = 0; i < 4000; ++i) noise += static_cast<char>((i * 2654435761u) >> 13);
  for (const std::string_view extension : kExtensions) {
    for (const std::string& content :
         {noise, std::string("hello\n"), std::string(1, '\0'), std::string(100'000, '{')}) {
      const std::string message = refusal(folder.write(text("a.", extension), content));
      EXPECT_TRUE(message.starts_with("a.")) << extension << ": " << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
}

TEST(BadFiles, Utf16IsNamedWithTheWayOut) {
  const TempFolder folder;
  for (const std::string_view extension : kExtensions) {
    if (extension == "ifc" || extension == "glb") continue;  // another reader's, and no text
    for (const bool little_endian : {true, false}) {
      for (const bool marked : {true, false}) {
        std::string bytes;
        for (const char c : std::string("solid text of any kind\nv 0 0 0\n"))
          bytes += little_endian ? std::string{c, '\0'} : std::string{'\0', c};
        if (marked) bytes = (little_endian ? "\xff\xfe" : "\xfe\xff") + bytes;
        const std::string name = text("a.", extension);
        EXPECT_EQ(refusal(folder.write(name, bytes)), name + ": is UTF-16 text; save it as UTF-8");
      }
    }
  }
}

TEST(BadFiles, UnknownExtensionsListTheKnownOnes) {
  const TempFolder folder;
  EXPECT_EQ(refusal(folder.write("a.txt", "x")),
            "a.txt: '.txt' is not the extension of a scene or model that is read; known are .json .obj .gltf .glb .ply "
            ".stl .off "
            ".dae .fbx .ifc");
}

TEST(BadFiles, ExtensionsMayBeInCapitals) {
  const TempFolder folder;
  EXPECT_EQ(read_scene(folder.write("A.OBJ", kRoomObj)).polygons.face_count(), 2u);
}

TEST(BadFiles, DevicesAreNotRead) {
  if (!std::filesystem::exists("/dev/zero")) GTEST_SKIP();
  const TempFolder folder;
  std::filesystem::create_symlink("/dev/zero", folder / "zero.obj");
  EXPECT_EQ(refusal(folder / "zero.obj"), folder / "zero.obj" + ": is not a regular file");
}

TEST(ModelsGivenDirectly, TakeUnitUpAndSkyOfTheCommandLine) {
  const TempFolder folder;
  const std::string room = folder.write("a.obj", kRoomObj);
  EXPECT_FALSE(read_scene(room).lights.sky);
  const Scene scene = read_scene(room, {.unit = {}, .up = {}, .sky = "uniform:17900"});
  EXPECT_EQ(scene.lights.sky->model, SkyModel::uniform);
  EXPECT_DOUBLE_EQ(scene.lights.sky->horizontal_irradiance[0], 100);
  EXPECT_DOUBLE_EQ(read_scene(room, {.unit = {}, .up = {}, .sky = "cie-overcast"}).lights.sky->horizontal_irradiance[0],
                   10'000 / 179.0);
  EXPECT_EQ(refusal(room, {.unit = {}, .up = {}, .sky = "overcast"}),
            "--sky 'overcast' is not known; did you mean 'cie-overcast'?");
  EXPECT_EQ(refusal(room, {.unit = {}, .up = {}, .sky = "uniform:bright"}),
            "--sky: 'bright' is not an illuminance in lux, [0, 1e15]; write cie-overcast:10000");
  EXPECT_EQ(refusal(room, {.unit = "km", .up = {}, .sky = {}}),
            "--unit 'km' is not known; known are m, cm, mm, ft, in");
  EXPECT_EQ(refusal(room, {.unit = {}, .up = "x", .sky = {}}), "--up 'x' is not known; known are y, z");
}

}  // namespace
}  // namespace clerestory
