#pragma once
// Links between the nodes of an element tree, stored where their light arrives.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace clerestory {

/// E += weight * B of the source node; weight is F V [1]. Eight bytes.
struct Link {
  std::uint32_t source;
  float weight;
};

/// While a scene has no more links, every hit keeps one of its own: nodes hide what is darker or brighter in them than
/// was known when the links were made, and a room lit by a spot on its ceiling loses 1 % by that. 256 MB.
inline constexpr double kLinksToSpare = 32e6;

/// Leaves in a row of the tree that receive together. A row of links is a sum of weight * B. A surface has one row,
/// which all of its leaves get alike. A cluster of small faces has a row for each part of the sphere that light comes
/// from, and hands each down by its members' orientation: E_m = sum over rows of share_m,row * row.
struct Receiver {
  std::uint32_t first_leaf, leaf_end;
  std::uint16_t rows = 1;
  bool hands_down = false;
  std::uint32_t views = 0;  ///< of the sky
  float view_weight = 0;    ///< of each of them [1]
};

/// A ray of a receiver's bundle that left the scene: where it looks at the sky, and what glass and mirrors let through.
/// Eight bytes, so that a ray that leaves costs what one that arrives does; see sky_views.h.
struct SkyView {
  std::uint64_t bits;
};

/// What members of a receiver that hands down need to know of a sky view beside it.
struct SharedView {
  std::uint32_t leaves;   ///< direction in which the ray left, before any mirror; packed
  std::uint32_t members;  ///< bit m: member m looks at it; rays of its own have found the others' sky
};

/// Receivers one after another, and all that belongs to them in the same order. A leaf is in one block only, so blocks
/// gather in parallel.
struct LinkBlock {
  std::uint32_t first_leaf = 0, leaf_end = 0;
  std::vector<Receiver> receivers;
  std::vector<std::uint32_t> row_end;  ///< by row, in `links`
  std::vector<Link> links;
  std::vector<float> shares;             ///< rows x leaves of each receiver that hands down; sum a_m share_m = sum a_m
  std::vector<SkyView> views;            ///< Receiver::views of each
  std::vector<SharedView> shared_views;  ///< of each receiver that hands down
};

/// How light gets from leaf to leaf, and into leaves from which part of the sky, whatever its amount.
struct Transport {
  std::vector<LinkBlock> blocks;
  // By PatchId.
  std::vector<float> arrives;        ///< N, share of what a leaf sends that reaches leaves [1]
  std::vector<float> escapes;        ///< N, share that leaves the scene; the rest goes into glass and dark sides [1]
  std::vector<std::uint32_t> space;  ///< N, leaves that exchange light, directly or over others, have one number
  std::size_t spaces = 0;
  bool has_gloss = false;  ///< as of Closure
  int bundle_rays = 0;     ///< from each receiver; 0: links were made otherwise
  unsigned long long rays = 0;
  bool complete = true;  ///< false: stopped early

  std::size_t link_count() const;
  std::size_t receiver_count() const;
};

inline std::size_t Transport::link_count() const {
  std::size_t count = 0;
  for (const LinkBlock& b : blocks) count += b.links.size();
  return count;
}
inline std::size_t Transport::receiver_count() const {
  std::size_t count = 0;
  for (const LinkBlock& b : blocks) count += b.receivers.size();
  return count;
}

}  // namespace clerestory
