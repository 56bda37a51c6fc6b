#pragma once
// Which picture of a result is asked for.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "solver/view/place_camera.h"

namespace clerestory {

struct ViewRequest {
  // From where; nothing of it: a view that fits.
  std::optional<Vec3> eye, target;  ///< both or neither; scene's frame [m]
  std::optional<Vec3> up;           ///< default: +z
  std::string camera;               ///< name of one in the model; else empty
  std::string scene;                ///< file of the scene; empty: where it was when it was solved
  std::optional<Cut> cut;           ///< plan or section
  bool fisheye = false;             ///< by eye and target, or by the camera
  bool outdoors = false;            ///< a drawing shows what is outdoors, too
  std::optional<double> fov;        ///< across the longer side, in (0, 180) [degrees]; default: the camera's, or 60

  int width = 1920, height = 1080, samples = 16;  ///< [pixel], rays a pixel

  bool raytrace = false;  ///< light straight from lamps and suns by rays, and their highlights
  int final_gather = 0;   ///< rays that look for all other light from each place that is seen; 0: it is the result's

  std::string show = "colour";                       ///< or luminance, or an array on the points of the result
  double ev = 0;                                     ///< of true colours: f-stops above the automatic exposure
  std::optional<std::pair<double, double>> range{};  ///< of false colours, low < high
  bool log_scale = false;
  std::vector<double> isolux{};

  /// The scene is wanted, not only the result.
  bool wants_lights() const { return raytrace || final_gather > 0; }
  bool shows_colour() const { return show == "colour"; }
  /// A drawing of a model that is looked into from outside, without sky.
  bool is_drawing() const { return cut || (camera.empty() && !eye); }
};

}  // namespace clerestory
