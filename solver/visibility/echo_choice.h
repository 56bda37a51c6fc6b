#pragma once
// Which of the panes on its way turns a ray back, or the gloss that it ends on sends it on.

#include <optional>

#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/visibility/ray_scene.h"

namespace clerestory {

/// Chooses one of the ways that a ray may take besides its own, each in proportion to what it brings.
class EchoChoice {
 public:
  EchoChoice(const Ray& ray, Echo* echo) : ray_(ray), echo_(echo) {}
  explicit operator bool() const { return echo_ != nullptr; }

  void offer(const Echo& next) {
    const double weight = luminous_mean(next.share);
    if (!(weight > 0)) return;
    all_ += weight;
    if (weight < all_ && !(random_number() * all_ < weight)) return;
    chosen_ = weight, *echo_ = next;
  }
  /// After the last.
  void finish() {
    if (echo_ && chosen_ > 0) echo_->share *= all_ / chosen_;
  }

 private:
  /// Its key is the ray: the same ray always has the same echo.
  double random_number() {
    if (!random_) random_.emplace(key_of(ray_, kPanesOfRay));
    return random_->uniform();
  }

  const Ray& ray_;
  Echo* echo_;
  double all_ = 0, chosen_ = 0;
  std::optional<RandomStream> random_;
};

}  // namespace clerestory
