#pragma once
// Flat passes over tree and links: pull, gather, push.

#include <array>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "solver/hierarchy/links.h"
#include "solver/model/channels.h"
#include "solver/model/element_tree.h"

namespace clerestory {

/// V x channels values of all nodes from N x channels of the leaves (by PatchId), averaged by area.
void pull(const ElementTree& tree, const Field& leaves, Field& nodes);

/// E_p = sum over links of weight * B, and down to the leaves. nodes: V x channels, from pull(); E: N x channels, by
/// PatchId. All channels of a link in one go; blocks in parallel.
void gather_and_push(const Transport& transport, const ElementTree& tree, const Field& nodes, Field& E);

/// Values of L distributions of light side by side.
template <std::size_t L>
struct alignas(L == 8 ? 64 : alignof(double)) Lanes {
  std::array<double, L> lane{};
};
/// The same of a node of the tree. Eight are floats: half of the memory that links reach for, and what they round is
/// 1e-8 of a row.
template <std::size_t L>
struct alignas(L == 8 ? 32 : alignof(double)) NodeLanes {
  using Value = std::conditional_t<L == 8, float, double>;
  std::array<Value, L> lane{};
};

/// pull(), then gather_and_push(), of N x L values by PatchId; L is 1, 3 or 8. Eight lanes take 1.4 times as long as
/// one.
template <std::size_t L>
class LinkGather {
 public:
  LinkGather(const ElementTree& tree, const Transport& transport) : tree_(tree), transport_(transport) {}
  void operator()(const std::vector<Lanes<L>>& B, std::vector<Lanes<L>>& E);

 private:
  const ElementTree& tree_;
  const Transport& transport_;
  std::vector<NodeLanes<L>> nodes_;
};

/// Radiosity of the nodes, as far as links need it.
struct NodeLight {
  std::vector<float> mean;       ///< V, luminous [W/m2]
  std::vector<float> deviation;  ///< V, standard deviation over the area, of the channel that varies most [W/m2]
};
NodeLight node_light(const ElementTree& tree, const Field& B);

}  // namespace clerestory
