#pragma once
// Which of many small discs a segment passes.

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "solver/model/vec.h"

namespace clerestory {

struct Disc {
  Vec3 centre, normal;  ///< normal: unit
  double radius;        ///< > 0
};

/// In single precision. Read-only, thread safe.
class Discs {
 public:
  explicit Discs(std::span<const Disc> discs);
  Discs(Discs&&) noexcept;
  ~Discs();

  /// passed(number of the disc, share of the way from `from` to `to`), in no order.
  using Passed = std::function<void(std::uint32_t disc, double share)>;
  void along(const Vec3& from, const Vec3& to, const Passed& passed) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace clerestory
