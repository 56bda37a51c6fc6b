#include "solver/hierarchy/receiver_area.h"

#include <algorithm>

namespace clerestory {

void ReceiverArea::look_at(const Receiver& receiver, const ElementTree& tree, const PatchSet& patches) {
  members_.clear();
  double sum = 0;
  for (std::uint32_t l = receiver.first_leaf; l < receiver.leaf_end; ++l) {
    const PatchId p{std::size_t{tree.patch[l]}};
    sum += patches.area[p];
    members_.push_back({p.value, patches.corner_positions(p), patches.normal[p], patches.area[p], sum});
  }
  hands_down_ = receiver.hands_down;
}

const ReceiverArea::Member& ReceiverArea::pick(double& x) const {
  if (members_.size() == 1) return members_[0];
  const double at = x * area();
  const auto m = std::upper_bound(members_.begin(), members_.end() - 1, at,
                                  [](double a, const Member& member) { return a < member.cumulative; });
  x = std::clamp((at - (m->cumulative - m->area)) / m->area, 0.0, 1 - 1e-12);
  return *m;
}

void ReceiverArea::find_shares(const Vec3& d, std::span<double> share) const {
  double sum = 0;
  for (std::size_t m = 0; m < members_.size(); ++m) {
    share[m] = std::max(0.0, dot(members_[m].normal, d));
    sum += members_[m].area * share[m];
  }
  for (double& s : share) s = sum > 0 ? s * area() / sum : 1;
}

}  // namespace clerestory
