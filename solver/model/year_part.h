#pragma once
// What `annual --part i/n` leaves for `merge`: the hours of its points, and what they are put together with.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "solver/model/annual.h"
#include "solver/model/channels.h"
#include "solver/model/sensors.h"
#include "solver/model/vec.h"

namespace clerestory {

inline constexpr std::size_t kMostParts = 1'000'000;  ///< of a year

/// A file that a run read.
struct FileOfRun {
  std::string name;    ///< the last part of its path
  std::string digest;  ///< of its bytes, see io/annual/file_digest.h
};

/// Points of a room or a grid, and the area that each stands for.
struct AreaPoints {
  std::vector<std::uint32_t> points;  ///< of the lightmap, or sensors
  std::vector<double> weight;         ///< [m2], or 1 each
};

/// All but the place of the part and the hours of its points is the same in all parts of one run.
struct YearPart {
  std::size_t part = 1, parts = 1;  ///< which of how many, 1 <= part <= parts <= kMostParts
  AnnualReport facts;               ///< rooms and grids without figures; the scene is what the report calls it
  std::vector<double> more_thresholds;
  std::vector<FileOfRun> files;
  std::vector<AreaPoints> rooms, grids;  ///< those of `facts`, in that order
  std::vector<SensorPoint> sensors;      ///< of all parts

  // How surfaces scatter, as PatchSet and VertexLightmap have it: P points, N patches.
  Vec3 origin;
  std::vector<Vec3> position;                             ///< P, local frame [m]
  std::vector<std::uint32_t> patch_of_point;              ///< P
  Field rho, tau;                                         ///< N; tau is empty where there are no diffusers
  std::vector<std::uint32_t> behind_begin, behind_patch;  ///< N + 1, and B patches; empty like tau
  std::vector<double> behind_share;                       ///< B

  std::size_t first_point = 0, first_sensor = 0;  ///< of this part
  std::vector<PointYear> of_points, of_sensors;   ///< of this part
};

}  // namespace clerestory
