#pragma once
// The triangles of a PatchSet as Embree has them.

#include <cstdint>
#include <functional>
#include <vector>

#include "solver/model/patch_set.h"
#include "solver/visibility/embree_device.h"

struct RTCSceneTy;

namespace clerestory {

/// One Embree scene over some triangles of the PatchSet; primitive k is triangle of_primitive[k].
struct EmbreeSurfaces {
  RTCSceneTy* handle = nullptr;
  std::vector<std::uint32_t> of_primitive;
  EmbreeSurfaces() = default;
  EmbreeSurfaces(const EmbreeSurfaces&) = delete;
  EmbreeSurfaces& operator=(const EmbreeSurfaces&) = delete;
  ~EmbreeSurfaces();

  /// glass: of the panes, or of all other triangles. Throws as EmbreeDevice does.
  void build(const EmbreeDevice& device, const PatchSet& patches, bool glass);

  /// Calls found(triangle) for the triangles whose boxes come within `reach` of p.
  void visit_near(const Vec3& p, double reach, const std::function<void(TriangleId)>& found) const;
};

}  // namespace clerestory
