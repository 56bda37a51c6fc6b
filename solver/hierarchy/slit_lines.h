#pragma once
// Light through slits, which rays of receivers meet by chance only.

#include <cstdint>
#include <span>
#include <vector>

#include "solver/hierarchy/receiver_area.h"
#include "solver/illumination/illumination.h"

namespace clerestory {

/// What one line through a slit joins: flux B weight arrives at the receiver.
struct SlitLine {
  std::uint32_t receiver, slit, source;  ///< patch, number in Lights::openings, patch
  float weight;                          ///< [m2]
  Vec3 place, direction;                 ///< at the receiver, and where it sees the slit from there
  double distance;                       ///< through the slit to the source [m]
};

/// Lines through all points of the slits among the openings, cosine-distributed about their normals. With the surface
/// that a line comes from on the bright side, q, and the one that it meets in the dark room, p, each of R lines brings
///   E_p += B_q A_slit / (R A_p)
/// so what a slit lets in is known as well however narrow it is. Light of the sky is left to the openings' own rays.
class SlitLines {
 public:
  SlitLines() = default;
  /// light  its slit gains tell how bright it is where lines end.
  SlitLines(const Illumination& light, std::uint64_t seed);

  /// Slits whose light the receiver has by these lines, in the order of their numbers: what its own rays find through
  /// them is not to count.
  std::vector<std::uint32_t> slits_over(const ReceiverArea& area) const;
  /// Lines that arrive at a patch, in the order of their slits.
  std::span<const SlitLine> at(std::uint32_t patch) const;
  unsigned long long rays() const { return rays_; }

 private:
  void drop_blocked(const std::vector<std::vector<SlitLine>>& lines_of);

  std::vector<LightArea> slits_;
  std::vector<std::uint32_t> number_;  ///< of slits_ among the openings
  std::vector<SlitLine> lines_;        ///< sorted by receiver, then slit
  unsigned long long rays_ = 0;
};

}  // namespace clerestory
