#include "pipeline/view/choose_camera.h"

#include <gtest/gtest.h>

#include "solver/model/error.h"
#include "tests/support/box_scene.h"
#include "tests/support/small_result.h"

namespace clerestory {
namespace {

/// A room from -2 to 2 m in x, y and z, solved for that file.
std::string refused(const ViewRequest& request, const std::string& input = "") {
  WrittenResult r = empty_result();
  add_room(r, 7, 100);
  r.texts["input"] = {input};
  try {
    choose_camera(r, r.file, request);
  } catch (const InputError& e) {
    return e.what();
  }
  return "not refused";
}

TEST(ChooseCamera, RefusesACutWithNothingBehindItAndSaysWhereTheModelIs) {
  ViewRequest below, beyond;
  below.cut = Cut{2, -3}, beyond.cut = Cut{0, 40};
  EXPECT_EQ(refused(below),
            "small.vtp: there is nothing below the plan at z = -3 m; the model's z goes from -2 to 2 m.");
  EXPECT_EQ(refused(beyond),
            "small.vtp: there is nothing beyond the section at x = 40 m; the model's x goes from -2 to 2 m.");
}

TEST(ChooseCamera, SaysWhatToDoWhereThereAreNoCameras) {
  const TempFolder folder;
  ViewRequest by_name;
  by_name.camera = "Kamera";
  EXPECT_EQ(refused(by_name, BoxScene{}.write(folder)),
            "room.json: has no camera, which only glTF files carry; say --eye and --target instead of --camera.");
  EXPECT_NE(refused(by_name, folder / "gone.glb").find("not there any more"), std::string::npos);
}

}  // namespace
}  // namespace clerestory
