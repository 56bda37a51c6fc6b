#include "pipeline/view/choose_camera.h"

#include <algorithm>
#include <cmath>

#include "io/input_file.h"
#include "io/read_cameras.h"
#include "io/scene_file/nearest_name.h"
#include "io/text.h"
#include "pipeline/scene_of_result.h"
#include "solver/model/box.h"
#include "solver/model/error.h"
#include "solver/model/inner_rooms.h"

namespace clerestory {
namespace {

constexpr double kUsualAngle = 60;  // [degrees]

SceneCamera camera_named(const WrittenResult& result, const std::filesystem::path& file, const ViewRequest& request) {
  const std::string& name = request.camera;
  const std::filesystem::path input =
      request.scene.empty()
          ? file_of_scene(result, file, "its cameras are there; say where it is, --scene FILE, or --eye and --target")
          : std::filesystem::path(request.scene);
  const std::vector<SceneCamera> cameras = read_cameras(input);
  if (cameras.empty())
    throw InputError(text(short_name(input), ": has no camera, which only glTF files carry; say --eye and --target ",
                          "instead of --camera."));
  for (const SceneCamera& camera : cameras)
    if (std::ranges::find(camera.names, name) != camera.names.end()) return camera;
  std::vector<std::string_view> known;
  for (const SceneCamera& camera : cameras)
    for (const std::string& other : camera.names)
      if (std::ranges::find(known, std::string_view(other)) == known.end()) known.push_back(other);
  const std::string near = suggestion(name, known);
  throw InputError(
      text(short_name(input), ": there is no camera '", quotable(name), "'; ", near, near.ends_with('?') ? "" : "."));
}

std::string extent_words(const WrittenResult& result, const Cut& cut) {
  const Box box = Box::around(result.points);
  const auto to_millimetres = [](double metres) { return std::round(1000 * metres) / 1000 + 0.0; };
  return text("the model's ", "xyz"[cut.axis], " goes from ", to_millimetres(box.lower[cut.axis]), " to ",
              to_millimetres(box.upper[cut.axis]), " m");
}

}  // namespace

std::vector<std::uint32_t> shown_triangles(const WrittenResult& result, const ViewRequest& request) {
  const std::vector<bool> inner = inner_rooms(result);
  const bool rooms_only = request.is_drawing() && !request.outdoors && !result.room.empty();
  std::vector<std::uint32_t> all, of_rooms;
  for (std::uint32_t i = 0; i < result.triangles.size(); ++i) {
    all.push_back(i);
    if (rooms_only && inner[result.room[i]]) of_rooms.push_back(i);
  }
  return of_rooms.empty() ? all : of_rooms;
}

Camera choose_camera(const WrittenResult& result, const std::filesystem::path& file, const ViewRequest& request) {
  const int width = request.width, height = request.height;
  if (request.cut) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (const std::uint32_t i : shown_triangles(result, request)) triangles.push_back(result.triangles[i]);
    const auto camera = camera_of_cut(*request.cut, result.points, triangles, width, height);
    if (!camera)
      throw InputError(text(result.file, ": there is nothing ",
                            request.cut->axis == 2 ? "below the plan at z = " : "beyond the section at ",
                            request.cut->axis == 2   ? ""
                            : request.cut->axis == 0 ? "x = "
                                                     : "y = ",
                            request.cut->place, " m; ", extent_words(result, *request.cut), "."));
    return *camera;
  }
  if (request.is_drawing()) {
    std::vector<Vec3> points;
    for (const std::uint32_t i : shown_triangles(result, request))
      for (const std::uint32_t corner : result.triangles[i]) points.push_back(result.points[corner]);
    return camera_that_fits(points, width, height);
  }
  Camera camera;
  camera.kind = request.fisheye ? CameraKind::fisheye : CameraKind::perspective;
  camera.width = width, camera.height = height;
  camera.half_width = half_width_of_angle(request.fov.value_or(kUsualAngle), width, height);
  if (!request.camera.empty()) {
    const SceneCamera from = camera_named(result, file, request);
    camera.eye = from.eye;
    camera.turn(from.forward, request.up.value_or(from.up));
    if (!request.fisheye && !request.fov && from.vertical_angle)
      camera.half_width = std::tan(*from.vertical_angle / 2) * width / height;
    if (!request.fisheye && !request.fov && !from.vertical_angle)
      camera.kind = CameraKind::orthographic, camera.half_width = from.half_height * width / height;
    return camera;
  }
  camera.eye = *request.eye;
  camera.turn(*request.target - *request.eye, request.up.value_or(Vec3{0, 0, 1}));
  return camera;
}

}  // namespace clerestory
