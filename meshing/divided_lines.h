#pragma once
// The lines between planar regions in pieces, which all regions that use a line share.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "meshing/surface_complex.h"

namespace clerestory {

inline constexpr double kLineShare = 0.8;  ///< even division of lines, as share of the longest edge

inline Ends ends_of(std::uint32_t a, std::uint32_t b) { return a < b ? Ends{a, b} : Ends{b, a}; }

/// Lines divided evenly, once for all regions that use them.
class DividedLines {
 public:
  /// longest: of an edge. Points along the lines are added to the vertices.
  DividedLines(FaceComplex& complex, const std::vector<PlanarDomain>& domains, double longest);

  std::span<const Ends> of_region(std::size_t d) const {
    return std::span(by_region_).subspan(begin_of_region_[d], begin_of_region_[d + 1] - begin_of_region_[d]);
  }
  /// The line that a piece or a half of one is part of, if it is.
  std::optional<Ends> whole(const Ends& e) const {
    if (const auto half = halves_.find(key(e)); half != halves_.end()) return uses_[half->second].first;
    const Piece* known = piece(e);
    if (!known) return std::nullopt;
    return uses_[known->first_use].first;
  }
  /// Halves a piece at a new vertex. Calls use(region) for every region that must do so too.
  template <class Use>
  void halve(FaceComplex& complex, const Ends& e, const Use& use) {
    std::uint32_t first_use = 0;
    if (const auto half = halves_.find(key(e)); half != halves_.end()) {
      first_use = half->second;
    } else {
      const Piece* known = piece(e);
      if (!known) return;  // a crossing that tolerances hid from other regions
      first_use = known->first_use;
    }
    const auto middle = static_cast<std::uint32_t>(complex.vertices.size());
    complex.vertices.push_back((complex.vertices[e[0]] + complex.vertices[e[1]]) / 2);
    halves_.emplace(key(ends_of(e[0], middle)), first_use);
    halves_.emplace(key(ends_of(e[1], middle)), first_use);
    for (const auto& [whole, d] : users(first_use)) use(d, middle);
  }

 private:
  using LineUse = std::pair<Ends, std::uint32_t>;  ///< line, region
  struct Piece {
    Ends ends;
    std::uint32_t first_use;  ///< of its line in uses_
  };
  const Piece* piece(const Ends& e) const {
    const auto known = std::lower_bound(pieces_.begin(), pieces_.end(), e,
                                        [](const Piece& p, const Ends& value) { return p.ends < value; });
    return known == pieces_.end() || known->ends != e ? nullptr : &*known;
  }
  static std::uint64_t key(const Ends& e) { return std::uint64_t{e[0]} << 32 | e[1]; }
  std::span<const LineUse> users(std::uint32_t first) const {
    std::size_t end = first;
    while (end < uses_.size() && uses_[end].first == uses_[first].first) ++end;
    return std::span(uses_).subspan(first, end - first);
  }

  std::vector<LineUse> uses_;
  std::vector<Piece> pieces_;
  std::vector<std::size_t> begin_of_region_;
  std::vector<Ends> by_region_;
  std::unordered_map<std::uint64_t, std::uint32_t> halves_;
};

}  // namespace clerestory
