#pragma once
// What was read: surfaces as polygons, materials, lights, sensors and settings. Nothing is meshed or checked for
// geometry defects here; coordinates are metres, z up, in double.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "solver/model/ids.h"
#include "solver/model/light_spec.h"
#include "solver/model/material.h"
#include "solver/model/named_space.h"
#include "solver/model/sensors.h"
#include "solver/model/solar_position.h"
#include "solver/model/vec.h"

namespace clerestory {

/// Polygons that share a vertex array. Face f has corners corner[face_begin[f]] .. corner[face_begin[f + 1] - 1],
/// counter-clockwise around its front. A polygon may be concave, and a hole may be joined to the outside by a
/// doubled edge (as OBJ writers do).
struct PolygonSoup {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> corner;
  std::vector<std::uint32_t> face_begin{0};  ///< F + 1
  std::vector<MaterialId> material;          ///< F
  std::vector<SurfaceId> surface;            ///< F

  std::size_t face_count() const { return material.size(); }
  void add_vertex(const Vec3& p) { vertices.push_back(p); }
  void add_corner(std::uint32_t vertex) { corner.push_back(vertex); }
  void end_face(MaterialId m, SurfaceId s) {
    face_begin.push_back(static_cast<std::uint32_t>(corner.size()));
    material.push_back(m);
    surface.push_back(s);
  }
};

/// Settings a scene file may hold under "solver"; a command line option wins over them.
struct SolverSettings {
  std::optional<std::string> method, accuracy, oracle;
  std::optional<double> max_element;        ///< [m]
  std::optional<double> detail;             ///< [m]
  std::optional<double> target_error;       ///< RMS relative [1]
  std::optional<double> time_limit;         ///< [s]
  std::optional<std::size_t> memory_limit;  ///< of the whole process [bytes]
  std::optional<std::uint64_t> seed;
};

/// What sun and sky go by, for people; the solver looks at the lights only.
struct Daylight {
  Horizontal sun;              ///< where it stands, up or set
  std::optional<Moment> time;  ///< for which it was computed; empty: the scene gives its direction
  struct Hour {
    std::string file;
    int month = 0, day = 0, hour = 0;  ///< hour 12 ends at 12:00
  };
  std::optional<Hour> weather;  ///< that sun and sky have their light from
};

/// One of several times that a scene is lit for.
struct SceneTime {
  Moment moment;
  Daylight daylight;  ///< as of Scene::daylight
};

/// Things of one kind in a model that its reader did not use or understand.
struct NotRead {
  std::string what;
  std::size_t count = 0;
  std::string first;  ///< name of one of them
};

/// A model as it stands in the scene.
struct PlacedModel {
  std::filesystem::path file;
  std::array<double, 12> place{};                    ///< 3 x 4, row-major: from the file's frame to the scene's [m]
  std::size_t first_surface = 0, surface_count = 0;  ///< of Scene::surfaces
};

struct Scene {
  std::string file;
  std::vector<std::filesystem::path> files;  ///< all that it was read from, or that these name
  std::vector<PlacedModel> models;           ///< in the order of their surfaces
  PolygonSoup polygons;
  std::vector<Material> materials;    ///< by MaterialId
  std::vector<std::string> surfaces;  ///< names, by SurfaceId
  LightSpec lights;
  double ground_reflectance = 0.2;   ///< of the virtual ground, where the scene was read for a year [1]
  std::optional<Daylight> daylight;  ///< empty: no sun, and no sky that depends on one
  std::vector<SceneTime> times;      ///< that `lights` are the mean of; empty: as they are
  std::optional<Place> place;        ///< on earth, as the scene file says it
  double north_deg = 0;              ///< of the scene's north, clockwise from +y, as the scene file says it
  std::vector<SensorSet> sensors;
  std::vector<NamedSpace> spaces;    ///< rooms that the models name
  std::vector<NamedSurfaces> rooms;  ///< that the scene file names
  SolverSettings settings;
  std::vector<std::string> unused_materials;  ///< material rules of the scene file that matched nothing
  std::vector<std::string> left_out;          ///< what models have that is not solved, by no mistake of theirs
  std::vector<std::string> warnings;          ///< what the reader assumed or left out, for people
  std::vector<NotRead> not_read;              ///< what readers did not use, in full
  std::optional<double> model_north_deg;      ///< true north as a model says it, clockwise from +y

  /// 1 when every reflectance, exitance, transmittance and light is grey, else 3.
  int channels() const;
};

/// Every colour replaced by its luminous mean.
void make_grey(std::vector<Material>& materials);
void make_grey(LightSpec& lights);

}  // namespace clerestory
