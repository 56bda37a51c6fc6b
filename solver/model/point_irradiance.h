#pragma once
// Irradiance at points, and where they are.

#include <cstddef>
#include <functional>

#include "solver/model/channels.h"
#include "solver/model/vec.h"

namespace clerestory {

/// A point that light is asked for at.
struct ReceivingPoint {
  Vec3 p;  ///< local frame, lifted off its surface [m]
  Vec3 n;  ///< unit normal of the receiving plane
};
/// The place of number i; called from several threads.
using PointOf = std::function<ReceivingPoint(std::size_t i)>;

struct PointIrradiance {
  Field E;               ///< P x channels [W/m2]; 0 from number `done` on
  Field std_error;       ///< of E; empty unless paths estimated it
  Field layers;          ///< P x lanes, E by layer; empty unless they were asked for
  std::size_t done = 0;  ///< less than P: stopped early
  unsigned long long rays = 0;

  bool complete() const { return done == E.size(); }
};

}  // namespace clerestory
