#include "solver/hierarchy/gather_links.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "solver/model/parallel.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

/// Lanes first ... first + C - 1 of `all`; those of a node lie side by side. Stride: `all` where it is known
/// beforehand.
template <std::size_t C, std::size_t Stride = 0>
void gather_block(const LinkBlock& block, const ElementTree& tree, const double* nodes, double* E, std::size_t all) {
  const std::size_t stride = Stride > 0 ? Stride : all;
  for (std::uint32_t l = block.first_leaf; l < block.leaf_end; ++l) std::fill_n(E + stride * tree.patch[l], C, 0.0);
  std::size_t link = 0, row = 0;
  const float* share = block.shares.data();
  for (const Receiver& r : block.receivers)
    for (std::uint32_t k = 0; k < r.rows; ++k, ++row) {
      std::array<double, C> sum{};
      for (const std::size_t last = block.row_end[row]; link < last; ++link) {
        const auto [source, weight] = block.links[link];
        for (std::size_t c = 0; c < C; ++c) sum[c] += double{weight} * nodes[stride * source + c];
      }
      for (std::uint32_t l = r.first_leaf; l < r.leaf_end; ++l) {
        const double part = r.hands_down ? double{*share++} : 1.0;
        for (std::size_t c = 0; c < C; ++c) E[stride * tree.patch[l] + c] += part * sum[c];
      }
    }
}

/// Any number of lanes, eight at a time: a cache line of each node. What they sum to does not depend on their company.
void gather_lanes(const LinkBlock& block, const ElementTree& tree, const double* nodes, double* E, std::size_t all) {
  std::size_t first = 0;
  for (; first + 8 <= all; first += 8) gather_block<8>(block, tree, nodes + first, E + first, all);
  for (; first + 4 <= all; first += 4) gather_block<4>(block, tree, nodes + first, E + first, all);
  for (; first < all; ++first) gather_block<1>(block, tree, nodes + first, E + first, all);
}

}  // namespace

void pull(const ElementTree& tree, const Field& leaves, Field& nodes) {
  const auto C = static_cast<std::size_t>(leaves.channels);
  const std::size_t n = tree.size();
  if (nodes.value.size() != n * C) nodes = Field(n, leaves.channels);
  std::fill(nodes.value.begin(), nodes.value.end(), 0.0);
  for (std::size_t v = n; v-- > 0;) {  // children before their parents
    const bool leaf = tree.is_leaf(static_cast<std::uint32_t>(v));
    double* value = nodes.value.data() + C * v;
    if (leaf) {
      const double* from = leaves.value.data() + C * tree.patch[tree.leaf_begin[v]];
      for (std::size_t c = 0; c < C; ++c) value[c] = from[c];
    } else {
      for (std::size_t c = 0; c < C; ++c) value[c] /= tree.area[v];
    }
    if (tree.parent[v] == ElementTree::kNone) continue;
    double* above = nodes.value.data() + C * tree.parent[v];
    for (std::size_t c = 0; c < C; ++c) above[c] += tree.area[v] * value[c];
  }
}

void gather_and_push(const Transport& transport, const ElementTree& tree, const Field& nodes, Field& E) {
  const auto lanes = static_cast<std::size_t>(nodes.channels);
  const auto gather = lanes == 1   ? gather_block<1, 1>
                      : lanes == 3 ? gather_block<3, 3>
                      : lanes == 8 ? gather_block<8, 8>
                                   : gather_lanes;
  parallel_for(transport.blocks.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      gather(transport.blocks[b], tree, nodes.value.data(), E.value.data(), lanes);
  });
}

NodeLight node_light(const ElementTree& tree, const Field& B) {
  Field mean;
  pull(tree, B, mean);
  const std::size_t n = tree.size();
  Field variance(n, B.channels);
  for (std::size_t v = n; v-- > 0;) {
    const std::size_t above = tree.parent[v];
    for (int c = 0; c < B.channels; ++c) {
      double& own = variance.at(v, c);
      if (!tree.is_leaf(static_cast<std::uint32_t>(v))) own /= tree.area[v];
      if (above == ElementTree::kNone) continue;
      const double apart = mean.at(v, c) - mean.at(above, c);
      variance.at(above, c) += tree.area[v] * (own + apart * apart);
    }
  }
  NodeLight light;
  light.mean.resize(n), light.deviation.resize(n);
  for (std::size_t v = 0; v < n; ++v) {
    light.mean[v] = static_cast<float>(luminous_mean(mean[v]));
    light.deviation[v] = static_cast<float>(std::sqrt(variance[v].max()));
  }
  return light;
}

}  // namespace clerestory
