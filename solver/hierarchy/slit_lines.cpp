#include "solver/hierarchy/slit_lines.h"

#include <algorithm>
#include <tuple>

#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/openings/openings.h"
#include "solver/sampling/unit_square.h"

namespace clerestory {
namespace {

constexpr std::uint32_t kLines = 8192;       ///< through one slit
constexpr std::size_t kMostLines = 1 << 20;  ///< through all of them
constexpr std::size_t kMostSlits = 8;        ///< that one receiver has by lines

}  // namespace

SlitLines::SlitLines(const Illumination& light, std::uint64_t seed) {
  const Problem& problem = light.problem;
  const std::vector<LightArea>& openings = problem.lights.openings;
  for (std::uint32_t k = 0; k < openings.size(); ++k)
    if (is_slit(openings[k])) slits_.push_back(openings[k]), number_.push_back(k);
  if (slits_.empty()) return;
  const auto count = static_cast<std::uint32_t>(std::min<std::size_t>(kLines, kMostLines / slits_.size()));
  std::vector<std::vector<SlitLine>> found(slits_.size());
  parallel_for(slits_.size(), 1, [&](std::size_t from, std::size_t to) {
    for (std::size_t s = from; s < to; ++s) {
      const LightArea& slit = slits_[s];
      const std::uint64_t key = stream_key(seed, kSlitLines, number_[s]);
      for (std::uint32_t k = 0; k < count; ++k) {
        const Ray in = ray_through(slit, slit.normal, key, k, problem.rays.lift());
        const Hit receiver = problem.rays.first_hit(problem.patches, in);
        if (!receiver.patch.valid()) continue;
        const Hit source = problem.rays.first_hit(problem.patches, {in.origin, -in.direction});
        if (!source.patch.valid()) continue;
        const double passes = luminous_mean(receiver.transmittance) * luminous_mean(source.transmittance) *
                              light.slit_gains.of(number_[s], slit, source.first);
        found[s].push_back({receiver.patch.value, number_[s], source.patch.value,
                            static_cast<float>(slit.area * passes / count), receiver.position(in),
                            -receiver.direction(in), receiver.distance + source.distance});
      }
    }
  });
  for (const auto& some : found) lines_.insert(lines_.end(), some.begin(), some.end());
  std::stable_sort(lines_.begin(), lines_.end(), [](const SlitLine& a, const SlitLine& b) {
    return std::tie(a.receiver, a.slit) < std::tie(b.receiver, b.slit);
  });
  rays_ = 2ull * count * slits_.size();
  drop_blocked(found);
}

/// Slits that no line comes through.
void SlitLines::drop_blocked(const std::vector<std::vector<SlitLine>>& lines_of) {
  std::size_t kept = 0;
  for (std::size_t s = 0; s < slits_.size(); ++s) {
    if (lines_of[s].empty()) continue;
    if (kept != s) slits_[kept] = std::move(slits_[s]);
    number_[kept++] = number_[s];
  }
  slits_.resize(kept);
  number_.resize(kept);
}

std::vector<std::uint32_t> SlitLines::slits_over(const ReceiverArea& area) const {
  if (slits_.empty() || area.hands_down()) return {};
  std::vector<std::uint32_t> over;
  for (const ReceiverArea::Member& m : area.members())
    for (const AreaOver& slit :
         areas_over(slits_, (m.corners[0] + m.corners[1] + m.corners[2]) / 3, m.normal, kMostSlits))
      over.push_back(number_[slit.number]);
  std::sort(over.begin(), over.end());
  over.erase(std::unique(over.begin(), over.end()), over.end());
  return over;
}

std::span<const SlitLine> SlitLines::at(std::uint32_t patch) const {
  const auto found = std::ranges::equal_range(lines_, patch, {}, &SlitLine::receiver);
  return {found.begin(), found.end()};
}

}  // namespace clerestory
