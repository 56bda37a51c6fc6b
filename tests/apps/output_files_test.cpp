// What is written, and what must never be: files of the scene, files of others, half a set of outputs.

#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/box_scene.h"
#include "tests/support/result_file.h"
#include "tests/support/run_program.h"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

/// A room that is read from many files.
class SceneOfManyFiles : public testing::Test {
 protected:
  void SetUp() override {
    BoxScene{}.write(folder_);
    folder_.write(
        "room.mtl",
        "newmtl wall\nKd 0.5 0.5 0.5\nmap_Kd -s 1 1 1 PLASTER.PNG\nMap_Ka back.png -clamp on\nbump my bump.png\n");
    folder_.write("room.obj", "mtllib room.mtl\n" + read_text(folder_ / "room.obj"));
    folder_.write("plaster.png", "pixels"), folder_.write("back.png", "pixels"), folder_.write("my bump.png", "pixels");
    folder_.write("pendant.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 2 1 1 2 0 0 0\n1 1 50\n0 90\n0\n100 0\n");
    folder_.write("lamp.ies", "IESNA:LM-63-2002\nTILT=lamp.tlt\n1 1000 1 2 1 1 2 0 0 0\n1 1 50\n0 90\n0\n100 0\n");
    folder_.write("lamp.tlt", "1\n2\n0 90\n1 1\n");
    folder_.write("points.csv", "1,1,1,0,0,1\n");
    std::string triangle(36 + 6, '\0');  // three corners, three indices
    const float corner[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const unsigned short index[3] = {0, 1, 2};
    std::memcpy(triangle.data(), corner, 36), std::memcpy(triangle.data() + 36, index, 6);
    folder_.write("box.bin", triangle), folder_.write("box.png", "pixels");
    folder_.write("box.gltf", R"({ "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }],
      "nodes": [{ "mesh": 0 }], "images": [{ "uri": "textures/BOX.png" }], "buffers": [{ "uri": "box.bin", "byteLength": 42 }],
      "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }],
      "bufferViews": [{ "buffer": 0, "byteLength": 36 }, { "buffer": 0, "byteOffset": 36, "byteLength": 6 }],
      "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                      "min": [0, 0, 0], "max": [1, 1, 0] },
                    { "bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR" }] })");
    scene_ = folder_.write("many.json", R"({ "geometry": [{ "file": "room.obj" }, { "file": "box.gltf" }],
      "luminaires": [{ "file": "lamp.ies", "position": [2, 1, 2] }], "fixtures": { "Pendant*": "pendant.ies" },
      "sensors": [{ "name": "points", "file": "points.csv" }] })");
    for (const auto& entry : fs::directory_iterator(folder_ / ".")) {
      const std::string name = entry.path().filename().string();
      if (name != "room.json") files_.push_back(name), content_.push_back(read_text(entry.path()));
    }
  }

  void expect_untouched() const {
    for (std::size_t i = 0; i < files_.size(); ++i) EXPECT_EQ(read_text(folder_ / files_[i]), content_[i]) << files_[i];
  }

  TempFolder folder_;
  std::string scene_;
  std::vector<std::string> files_, content_;
};

TEST_F(SceneOfManyFiles, CanBeSolved) {
  const TempFolder out;
  const ProgramRun run = run_program({"solve", scene_, "-o", out / "out.vtp", "--accuracy", "draft"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(files_.size(), 13u);
}

TEST_F(SceneOfManyFiles, IsNeverWrittenOver) {
  const TempFolder out;
  for (const std::string& name : files_) {
    fs::create_symlink(folder_ / name, out / "link.vtp");
    fs::create_hard_link(folder_ / name, out / "hard.csv");
    fs::create_symlink(out / "link.vtp", out / "chain.vtp");
    const std::vector<std::vector<std::string>> commands = {
        {"check", scene_, "--report", folder_ / name},
        {"check", scene_, "--log", folder_ / name},
        {"mesh", scene_, "-o", out / "link.vtp"},
        {"mesh", scene_, "-o", out / "chain.vtp"},
        {"formfactors", scene_, "-o", out / "hard.csv"},
        {"formfactors", scene_, "-o", out / "f.csv", "--log", out / "hard.csv"},
        {"solve", scene_, "-o", out / "link.vtp"},
        {"solve", scene_, "-o", out / "out.vtp", "--report", folder_ / name},
        {"solve", scene_, "-o", out / "out.vtp", "--log", out / "hard.csv"},
        {"solve", scene_, "-o", out / "out.vtp", "--sensors-out", out / "hard.csv"}};
    for (const auto& command : commands) {
      const ProgramRun run = run_program(command);
      EXPECT_EQ(run.exit_code, 3) << command[0] << " over " << name << "\n" << run.err;
      EXPECT_TRUE(run.err.find("is a file of the scene") != std::string::npos ||
                  run.err.find("is the input") != std::string::npos)
          << run.err;
    }
    expect_untouched();
    EXPECT_EQ(out.listing(), "chain.vtp hard.csv link.vtp ") << "nothing else is left behind";
    for (const char* link : {"link.vtp", "hard.csv", "chain.vtp"}) fs::remove(out / link);
  }
}

TEST_F(SceneOfManyFiles, TheSensorsOwnNameForTheirOutputIsRefusedWhenItIsTheirInput) {
  folder_.write("many.json", R"({ "geometry": [{ "file": "room.obj" }], "luminaires": [{ "type": "point",
    "position": [2, 1, 2], "luminous_flux": 800 }], "sensors": [{ "name": "s", "file": "office.sensors.csv" }] })");
  const std::string sensors = folder_.write("office.sensors.csv", "1,1,1,0,0,1\n");
  const ProgramRun run = run_program({"solve", scene_, "-o", folder_ / "office.vtp"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("--sensors-out"), std::string::npos) << run.err;
  EXPECT_EQ(read_text(sensors), "1,1,1,0,0,1\n");
  EXPECT_FALSE(fs::exists(folder_ / "office.vtp"));
}

/// A room, and the outputs of yesterday.
class OldOutputs : public testing::Test {
 protected:
  TempFolder elsewhere_, folder_;
  std::string scene_ = BoxScene{}.write(elsewhere_);
  std::string solve_ = "$CLERESTORY solve " + scene_ + " --max-element 1 --sensors " +
                       elsewhere_.write("s.csv", "1,1,1,0,0,1\n") + " -o " + folder_.write("o.vtp", kOld) +
                       " --sensors-out " + folder_.write("s.csv", kOld);

  void expect_all_old(const ProgramRun& run, const char* words) const {
    EXPECT_EQ(run.exit_code, 3) << run.err;
    EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
    for (const char* name : {"o.vtp", "s.csv"}) EXPECT_EQ(read_text(folder_ / name), kOld) << name;
    EXPECT_EQ(folder_.listing(), "o.vtp s.csv ");
  }
  static constexpr const char* kOld = "of yesterday";
};

TEST_F(OldOutputs, StayAllWhenTheDiskIsFullUnderOne) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  expect_all_old(run_by_shell(solve_ + " --report /dev/full"), "/dev/full: cannot be written: the disk is full");
  expect_all_old(run_by_shell(solve_ + " --log /dev/full"), "the disk is full");
  expect_all_old(run_by_shell(solve_ + " > /dev/full"), "standard output cannot be written: the disk is full");
  expect_all_old(run_by_shell("$CLERESTORY check " + scene_ + " > /dev/full"), "standard output");
}

TEST_F(OldOutputs, StayAllWhenAFileGrowsBeyondItsLimit) {
  // In units of 512 bytes: enough for the table, too little for the result.
  for (const char* limit : {"2", "20"})
    expect_all_old(run_by_shell("ulimit -f " + std::string(limit) + "; " + solve_), "ulimit -f");
}

TEST_F(OldOutputs, AreReplacedWithTheirModeAndNewOnesFollowTheMask) {
  fs::permissions(folder_ / "o.vtp", fs::perms(0640));
  ASSERT_EQ(run_by_shell("umask 027; " + solve_ + " --report " + (folder_ / "r.json")).exit_code, 0);
  EXPECT_GT(read_result(folder_ / "o.vtp").triangles.size(), 0u);
  EXPECT_EQ(fs::status(folder_ / "o.vtp").permissions(), fs::perms(0640));
  EXPECT_EQ(fs::status(folder_ / "r.json").permissions(), fs::perms(0640));
  EXPECT_EQ(folder_.listing(), "o.vtp r.json s.csv ");
}

TEST_F(OldOutputs, TakeWhatDeadRunsLeftWithThemAndNotWhatLivingOnesWrite) {
  folder_.write("o.vtp.tmp-0123456789abcdef", "of a run that was killed");
  const std::string living = folder_.write("o.vtp.tmp-fedcba9876543210", "of a run that goes on");
  folder_.write("o.vtp.tmp-of-the-user", "a name like ours");
  const int held = ::open(living.c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(::flock(held, LOCK_EX | LOCK_NB), 0);
  ASSERT_EQ(run_by_shell(solve_).exit_code, 0);
  EXPECT_EQ(folder_.listing(), "o.vtp o.vtp.tmp-fedcba9876543210 o.vtp.tmp-of-the-user s.csv ");
  ::close(held);
}

TEST_F(OldOutputs, AreWrittenThroughLinksAlsoWhereTheirTargetIsYetToCome) {
  fs::create_directory(folder_ / "far");
  fs::create_symlink("far/new.vtp", folder_ / "b.vtp");
  fs::create_symlink("b.vtp", folder_ / "a.vtp");
  ASSERT_EQ(run_program({"mesh", scene_, "-o", folder_ / "a.vtp"}).exit_code, 0);
  EXPECT_TRUE(fs::is_symlink(folder_ / "a.vtp") && fs::is_symlink(folder_ / "b.vtp"));
  EXPECT_GT(read_result(folder_ / "far/new.vtp").triangles.size(), 0u);
}

TEST_F(OldOutputs, MayBeStandardOutput) {
  const ProgramRun run = run_by_shell("$CLERESTORY check " + scene_ + " --quiet --report /dev/stdout");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out.substr(0, 2), "{\n");
  EXPECT_EQ(run.out.substr(run.out.size() - 2), "}\n");
}

TEST(StandardFiles, ThatAreClosedAreNotTakenForOthers) {
  const TempFolder folder;
  folder.write("tri.dae", R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema"
    version="1.4.1"><asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset><library_geometries>
    <geometry id="g" name="g"><mesh><source id="p"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array>
    <technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y"
    type="float"/><param name="Z" type="float"/></accessor></technique_common></source><vertices id="v"><input
    semantic="POSITION" source="#p"/></vertices><triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/>
    <p>0 1 2</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node
    id="n" name="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes><scene>
    <instance_visual_scene url="#s"/></scene></COLLADA>)");
  for (const char* closed : {"0<&-", "1>&-", "2>&-", "0<&- 1>&-", "0<&- 1>&- 2>&-"}) {
    const ProgramRun run =
        run_by_shell("$CLERESTORY check " + (folder / "tri.dae") + " --log " + (folder / "log") + " " + closed);
    EXPECT_EQ(run.exit_code, 0) << closed << "\n" << read_text(folder / "log");
  }
}

TEST(Echo, OfAFileThatIsOfAnotherKindIsShort) {
  const TempFolder folder;
  BoxScene{}.write(folder);
  const std::string secret = "root:x:0:0:a-secret-that-is-longer-than-forty-characters-and-is-not-for-messages\x1b[31m";
  const std::string beyond = "forty-characters-and-is-not-for-messages";
  folder.write("secret", secret + "\n" + secret + "\n");
  folder.write("lamp.ies", "IESNA:LM-63-2002\nTILT=secret\n1 1000 1 2 1 1 2 0 0 0\n1 1 50\n0 90\n0\n100 0\n");
  const std::string geometry = R"({ "geometry": [{ "file": "room.obj" }], )";
  const std::vector<std::string> scenes = {
      folder.write("a.json", geometry + R"("luminaires": [{ "file": "lamp.ies", "position": [1, 1, 1] }] })"),
      folder.write("b.json", geometry + R"("sky": { "model": "perez", "weather": "secret" },
                                           "time": "2026-06-21T12:00" })"),
      folder.write("c.json", geometry + R"("sensors": [{ "name": "s", "file": "secret" }] })"),
      folder.write("secret.json", secret),
      folder.write("secret.obj", "f " + secret),
      folder.write("secret.ply", secret),
      folder.write("secret.off", secret),
      folder.write("secret.stl", secret),
      folder.write("secret.gltf", secret),
      folder.write("secret.ifc", secret),
      folder.write("secret.dae", secret)};
  for (const std::string& scene : scenes) {
    const ProgramRun run = run_program({"check", scene});
    EXPECT_EQ(run.exit_code, 3) << scene << run.err;
    EXPECT_EQ(run.err.find(beyond), std::string::npos) << run.err;
    EXPECT_EQ(run.err.find('\x1b'), std::string::npos) << run.err;
  }
}

}  // namespace
}  // namespace clerestory
