#pragma once
// Light of luminaires and suns on its way from what turns it and shows no image of them: curved mirrors, curved gloss.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "solver/model/channels.h"
#include "solver/model/ids.h"
#include "solver/model/vec.h"

namespace clerestory {

/// One side of a triangle that turns light so.
struct CausticSide {
  std::array<Vec3, 3> corners;  ///< local frame [m]
  Vec3 normal;                  ///< unit, on that side
  TriangleId triangle;          ///< of the rays
  Spectrum mirror{0.0};         ///< reflectance; black: it is glossy
  double weight = 0;            ///< of its choice: about what it sends on [W]
};

/// A particle of it from one surface to the next.
struct CausticLeg {
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::array<float, 3> from, to;  ///< local frame [m]
  std::array<float, 3> flux;      ///< by channel, where it starts [W]
  std::uint32_t light;            ///< number of the luminaire or sun, as in Layer::lights
  TriangleId triangle;            ///< of the rays, that it ends on; invalid where it leaves the scene
  bool on_front;                  ///< of the triangle
  std::array<float, 2> uv;        ///< weights of its corners 1 and 2

  Vec3 start() const { return {double{from[0]}, double{from[1]}, double{from[2]}}; }
  Vec3 end() const { return {double{to[0]}, double{to[1]}, double{to[2]}}; }
  Spectrum sent() const { return {double{flux[0]}, double{flux[1]}, double{flux[2]}}; }
};

/// Legs that copies have in common.
class CausticLegs {
 public:
  CausticLegs() = default;
  CausticLegs(std::vector<CausticLeg> legs) : legs_(std::make_shared<const std::vector<CausticLeg>>(std::move(legs))) {}

  operator std::span<const CausticLeg>() const {
    return legs_ ? std::span<const CausticLeg>(*legs_) : std::span<const CausticLeg>();
  }
  bool empty() const { return !legs_ || legs_->empty(); }

 private:
  std::shared_ptr<const std::vector<CausticLeg>> legs_;
};

struct Caustics {
  std::vector<CausticSide> sides;
  CausticLegs legs;
  std::size_t particles = 0;  ///< to be sent; each has no leg, or some
  /// About so many legs tell the irradiance at a point: more are less noise, and more blur.
  std::size_t legs_of_point = 0;
};

}  // namespace clerestory
