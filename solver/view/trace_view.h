#pragma once
// What a camera sees of a result, as numbers.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/model/gloss.h"
#include "solver/model/monitor.h"
#include "solver/model/view_image.h"
#include "solver/model/written_result.h"
#include "solver/view/camera.h"
#include "solver/view/fine_light.h"
#include "solver/visibility/glass_sheet.h"
#include "solver/visibility/seen_surfaces.h"

namespace clerestory {

/// What is seen: values on the points of one-sided triangles, linear on them.
struct ShownField {
  int channels = 1;              ///< 1 or 3
  std::vector<float> of_points;  ///< rows of so many
  /// Radiance [W/(m2 sr)]: mirrors and panes take their share and turn some, and the sky may be seen. Else a quantity
  /// of surfaces: a mirror shows that of what it mirrors, a pane is not there.
  bool is_radiance = true;
};

/// Radiance of diffuse surfaces, B / pi.
ShownField radiance_of(const WrittenResult& result);

/// The same fields where only E [W/m2], P x channels, falls on the surfaces: what they send or receive of it, and what
/// they glow or pass on from behind. Of radiance, else of illuminance [lx].
ShownField radiance_of(const WrittenResult& result, const Field& E);
ShownField illuminance_of(const Field& E);

class ViewScene;

struct ViewOptions {
  int samples = 16;      ///< rays a pixel
  bool sees_sky = true;  ///< by radiance; else there is nothing beyond the surfaces
  double most = 1e30;    ///< values above are taken as this, each ray's for itself

  /// Null: the field is all there is. Else each place that is seen has this light besides, which the field leaves out:
  /// it is radiance, or illuminance of one channel.
  const FineLight* fine = nullptr;
  /// With `fine`: so many rays look around from each place that is seen, in a field of radiance that has all light, and
  /// what they meet lights it, too. 0: the field has that.
  int gather = 0;
  const ViewScene* around = nullptr;
};

class ViewScene {
 public:
  /// triangles  of the result that are shown, by number. The result outlives it.
  ViewScene(const WrittenResult& result, ShownField field, std::vector<std::uint32_t> triangles);

  /// Empty when the monitor stopped it.
  ///
  /// Threads: same bits for any thread count. Rays are turned by mirrors and panes, and by gloss, each into one
  /// direction of its lobe, or four where light is found by rays, until less than 1 % of the light would come that way,
  /// 16 times at most. Rays of a gather are turned alike.
  ViewImage trace(const Camera& camera, const ViewOptions& options, const Monitor& monitor = {}) const;

  const SeenSurfaces& surfaces() const { return surfaces_; }
  /// Corners of the triangles that are shown.
  const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return triangles_; }
  /// Share of all directions in which the eye meets the back of something first: above one half, it is inside of it.
  double backs_around(const Vec3& eye) const;

 private:
  class Ways;
  struct Pane {
    Vec3 normal;           ///< unit
    Spectrum mirror{0.0};  ///< reflectance
    int table = -1;        ///< of `glass_`; below 0: a mirror
  };
  const WrittenResult& result_;
  ShownField field_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::uint32_t> shown_panes_;  ///< of the result
  std::vector<Pane> panes_;
  std::vector<GlassTable> glass_;
  std::vector<Lobe> lobes_;              ///< of glossy materials, where light is shown
  std::vector<int> lobe_of_material_;    ///< below 0: none; empty: there are no lobes
  std::vector<std::uint32_t> material_;  ///< of the triangles that are shown; empty unless it is radiance
  std::vector<bool> is_black_;           ///< of them: the back of one-sided material; empty unless it is radiance
  std::vector<float> corner_values_;     ///< 3 x channels a triangle
  std::vector<Vec3> normal_;             ///< of points, unit: the mean of the facets that share one, by their angles
  SeenSurfaces surfaces_;
};

}  // namespace clerestory
