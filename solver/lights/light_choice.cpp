#include "solver/lights/light_choice.h"

#include <utility>

namespace clerestory {
namespace {

bool is_in_front(const LightChoice::Sun& sun, const Vec3& n) {
  return dot(sun.direction, n) > -0.01;  // the disc is half a degree wide
}

}  // namespace

LightChoice::LightChoice(const std::vector<LightBounds>& luminaires, std::vector<Sun> suns, double extent)
    : count_(static_cast<std::uint32_t>(luminaires.size())), suns_(std::move(suns)) {
  if (!luminaires.empty()) luminaires_ = LightTree(luminaires, Falloff::none, extent);
}

LightChoice::Shares LightChoice::shares(const Vec3& p, const Vec3& n) const {
  Shares s;
  if (!luminaires_.empty() && luminaires_.reaches(p, n)) s.luminaires = 1;
  for (const Sun& sun : suns_)
    if (is_in_front(sun, n)) s.sun_power += sun.power, s.suns = 1;
  if (s.luminaires > 0 && s.suns > 0) s.luminaires = s.suns = 0.5;
  return s;
}

LightTree::Choice LightChoice::choose(const Vec3& p, const Vec3& n, double pick) const {
  const Shares s = shares(p, n);
  if (pick < s.luminaires) {
    LightTree::Choice choice = luminaires_.choose({luminaires_, p, n}, pick / s.luminaires);
    choice.probability *= s.luminaires;
    return choice;
  }
  if (!(s.suns > 0)) return {};
  double left = (pick - s.luminaires) / s.suns * s.sun_power;
  LightTree::Choice choice;
  for (std::uint32_t k = 0; k < suns_.size(); ++k) {
    if (!is_in_front(suns_[k], n)) continue;
    choice = {count_ + k, s.suns * suns_[k].power / s.sun_power};
    left -= suns_[k].power;
    if (left < 0) break;
  }
  return choice;
}

double LightChoice::probability(std::uint32_t light, const Vec3& p, const Vec3& n) const {
  const Shares s = shares(p, n);
  if (light < count_) return s.luminaires > 0 ? s.luminaires * luminaires_.probability(light, {luminaires_, p, n}) : 0;
  const Sun& sun = suns_[light - count_];
  return is_in_front(sun, n) ? s.suns * sun.power / s.sun_power : 0;
}

}  // namespace clerestory
