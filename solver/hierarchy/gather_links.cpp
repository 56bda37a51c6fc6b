#include "solver/hierarchy/gather_links.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "solver/model/parallel.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

template <std::size_t C>
void gather_block(const LinkBlock& block, const ElementTree& tree, const double* nodes, double* E) {
  for (std::uint32_t l = block.first_leaf; l < block.leaf_end; ++l) std::fill_n(E + C * tree.patch[l], C, 0.0);
  std::size_t link = 0, row = 0;
  const float* share = block.shares.data();
  for (const Receiver& r : block.receivers)
    for (std::uint32_t k = 0; k < r.rows; ++k, ++row) {
      std::array<double, C> sum{};
      for (const std::size_t last = block.row_end[row]; link < last; ++link) {
        const auto [source, weight] = block.links[link];
        for (std::size_t c = 0; c < C; ++c) sum[c] += double{weight} * nodes[C * source + c];
      }
      for (std::uint32_t l = r.first_leaf; l < r.leaf_end; ++l) {
        const double part = r.hands_down ? double{*share++} : 1.0;
        for (std::size_t c = 0; c < C; ++c) E[C * tree.patch[l] + c] += part * sum[c];
      }
    }
}

// Sum over a row of links. Eight products of floats make a sum that is added up as double: what that rounds is 1e-8 of
// a row, and it takes no more instructions than one lane in double. Nothing is contracted (see CMakeLists.txt), and
// lanes add up by themselves, so all processors find the same bits.
using SumRow = Lanes<8> (*)(std::span<const Link> row, const NodeLanes<8>* nodes);

Lanes<8> sum_row(std::span<const Link> row, const NodeLanes<8>* nodes) {
  Lanes<8> sum;
  for (std::size_t l = 0; l < 8; ++l) {
    const auto arrives = [&](std::size_t k) { return row[k].weight * nodes[row[k].source].lane[l]; };
    const auto four = [&](std::size_t k) { return (arrives(k) + arrives(k + 1)) + (arrives(k + 2) + arrives(k + 3)); };
    std::size_t k = 0;
    for (; k + 8 <= row.size(); k += 8) sum.lane[l] += double{four(k) + four(k + 4)};
    for (; k < row.size(); ++k) sum.lane[l] += double{arrives(k)};
  }
  return sum;
}

#if defined(__x86_64__)
#define CLERESTORY_AVX __attribute__((target("avx"), always_inline))
[[gnu::target("avx")]] Lanes<8> sum_row_avx(std::span<const Link> row, const NodeLanes<8>* nodes) {
  __m256d low = _mm256_setzero_pd(), high = _mm256_setzero_pd();
  const auto arrives = [&](std::size_t k) CLERESTORY_AVX {
    return _mm256_mul_ps(_mm256_broadcast_ss(&row[k].weight), _mm256_load_ps(nodes[row[k].source].lane.data()));
  };
  const auto four = [&](std::size_t k) CLERESTORY_AVX {
    return _mm256_add_ps(_mm256_add_ps(arrives(k), arrives(k + 1)), _mm256_add_ps(arrives(k + 2), arrives(k + 3)));
  };
  const auto add = [&](const __m256& some) CLERESTORY_AVX {
    low = _mm256_add_pd(low, _mm256_cvtps_pd(_mm256_castps256_ps128(some)));
    high = _mm256_add_pd(high, _mm256_cvtps_pd(_mm256_extractf128_ps(some, 1)));
  };
  std::size_t k = 0;
  for (; k + 8 <= row.size(); k += 8) add(_mm256_add_ps(four(k), four(k + 4)));
  for (; k < row.size(); ++k) add(arrives(k));
  Lanes<8> sum;
  _mm256_store_pd(sum.lane.data(), low);
  _mm256_store_pd(sum.lane.data() + 4, high);
  return sum;
}
#undef CLERESTORY_AVX
SumRow sum_row_of_this_processor() { return __builtin_cpu_supports("avx") ? sum_row_avx : sum_row; }
#else
SumRow sum_row_of_this_processor() { return sum_row; }
#endif

void gather_eight(const LinkBlock& block, const ElementTree& tree, const NodeLanes<8>* nodes, SumRow add_up,
                  std::vector<Lanes<8>>& E) {
  const std::span<const Link> links = block.links;
  std::size_t begin = 0, row = 0;
  const float* share = block.shares.data();
  for (const Receiver& r : block.receivers)
    for (std::uint32_t k = 0; k < r.rows; ++k, ++row) {
      const Lanes<8> sum = add_up(links.subspan(begin, block.row_end[row] - begin), nodes);
      begin = block.row_end[row];
      for (std::uint32_t l = r.first_leaf; l < r.leaf_end; ++l) {
        const double part = r.hands_down ? double{*share++} : 1.0;
        Lanes<8> all = k > 0 ? E[tree.patch[l]] : Lanes<8>{};
        for (std::size_t c = 0; c < 8; ++c) all.lane[c] += part * sum.lane[c];
        E[tree.patch[l]] = all;
      }
    }
}

template <std::size_t L>
void gather_blocks(const Transport& transport, const ElementTree& tree, const std::vector<NodeLanes<L>>& nodes,
                   std::vector<Lanes<L>>& E) {
  const SumRow add_up = sum_row_of_this_processor();
  parallel_for(transport.blocks.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      if constexpr (L == 8)
        gather_eight(transport.blocks[b], tree, nodes.data(), add_up, E);
      else
        gather_block<L>(transport.blocks[b], tree, nodes.data()->lane.data(), E.data()->lane.data());
  });
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
  const auto gather = nodes.channels == 1 ? gather_block<1> : gather_block<3>;
  parallel_for(transport.blocks.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) gather(transport.blocks[b], tree, nodes.value.data(), E.value.data());
  });
}

template <std::size_t L>
void LinkGather<L>::operator()(const std::vector<Lanes<L>>& B, std::vector<Lanes<L>>& E) {
  using Value = typename NodeLanes<L>::Value;
  // Children come before their parents and next to them, so sums that are not complete yet belong to ancestors.
  struct Sum {
    std::uint32_t node;
    Lanes<L> flux{};
  };
  std::vector<Sum> open;
  nodes_.resize(tree_.size());
  for (std::size_t v = tree_.size(); v-- > 0;) {
    Lanes<L> value;
    if (tree_.is_leaf(static_cast<std::uint32_t>(v))) {
      value = B[tree_.patch[tree_.leaf_begin[v]]];
    } else {
      for (std::size_t l = 0; l < L; ++l) value.lane[l] = open.back().flux.lane[l] / tree_.area[v];
      open.pop_back();
    }
    for (std::size_t l = 0; l < L; ++l) nodes_[v].lane[l] = static_cast<Value>(value.lane[l]);
    const std::uint32_t above = tree_.parent[v];
    if (above == ElementTree::kNone) continue;
    if (open.empty() || open.back().node != above) open.push_back({above});
    const double area = tree_.area[v];
    Lanes<L> flux = open.back().flux;
    for (std::size_t l = 0; l < L; ++l) flux.lane[l] += area * value.lane[l];
    open.back().flux = flux;
  }
  gather_blocks<L>(transport_, tree_, nodes_, E);
}
template class LinkGather<1>;
template class LinkGather<3>;
template class LinkGather<8>;

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
