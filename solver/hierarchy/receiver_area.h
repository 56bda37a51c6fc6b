#pragma once
// The area that a receiver collects on: points of it, and what each of its members gets.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/hierarchy/links.h"
#include "solver/model/element_tree.h"
#include "solver/model/patch_set.h"

namespace clerestory {

/// The leaves of a receiver, its members, one after another along their area: a single one, or up to kMostMembers of a
/// cluster.
class ReceiverArea {
 public:
  struct Member {
    std::uint32_t patch;
    std::array<Vec3, 3> corners;
    Vec3 normal;
    double area, cumulative;  ///< its own, and with those before it [m2]
  };

  /// From now on the area of this one; keeps its memory from receiver to receiver.
  void look_at(const Receiver& receiver, const ElementTree& tree, const PatchSet& patches);

  std::span<const Member> members() const { return members_; }
  double area() const { return members_.back().cumulative; }  ///< [m2]
  /// Whether members get light by their orientation, and not all alike.
  bool hands_down() const { return hands_down_; }

  /// The member at the share x in [0, 1) of the area; x becomes the place within it, uniform again.
  const Member& pick(double& x) const;

  /// What member m gets of light from d (unit), against an even share by area: cos_m sum a / sum a cos. As rays leave
  /// from the members by area, this conserves the flux of each ray exactly.
  void find_shares(const Vec3& d, std::span<double> share) const;

 private:
  std::vector<Member> members_;
  bool hands_down_ = false;
};

}  // namespace clerestory
