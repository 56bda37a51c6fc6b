#include "meshing/divided_lines.h"

#include <algorithm>
#include <cmath>

namespace clerestory {

DividedLines::DividedLines(FaceComplex& complex, const std::vector<PlanarDomain>& domains, double longest) {
  std::size_t count = 0;
  for (const PlanarDomain& d : domains) count += d.lines.size();
  uses_.reserve(count);
  for (std::uint32_t d = 0; d < domains.size(); ++d)
    for (const Ends& l : domains[d].lines) uses_.push_back({ends_of(l[0], l[1]), d});
  std::sort(uses_.begin(), uses_.end());
  uses_.erase(std::unique(uses_.begin(), uses_.end()), uses_.end());
  begin_of_region_.assign(domains.size() + 1, 0);
  pieces_.reserve(uses_.size());
  for (std::uint32_t k = 0; k < uses_.size();) {
    const Ends whole = uses_[k].first;
    const std::uint32_t first_use = k;
    const std::size_t first_piece = pieces_.size();
    const Vec3 a = complex.vertices[whole[0]], b = complex.vertices[whole[1]];
    const int pieces = std::max(1, static_cast<int>(std::ceil(length(b - a) / (kLineShare * longest) - 1e-9)));
    std::uint32_t from = whole[0];
    for (int i = 1; i <= pieces; ++i) {
      std::uint32_t to = whole[1];
      if (i < pieces) {
        to = static_cast<std::uint32_t>(complex.vertices.size());
        complex.vertices.push_back(a + (b - a) * (static_cast<double>(i) / pieces));
      }
      pieces_.push_back({ends_of(from, to), first_use});
      from = to;
    }
    for (; k < uses_.size() && uses_[k].first == whole; ++k)
      begin_of_region_[uses_[k].second + 1] += pieces_.size() - first_piece;
  }
  for (std::size_t d = 0; d < domains.size(); ++d) begin_of_region_[d + 1] += begin_of_region_[d];
  by_region_.resize(begin_of_region_.back());
  std::vector<std::size_t> next(begin_of_region_.begin(), begin_of_region_.end() - 1);
  for (const Piece& p : pieces_)
    for (const auto& [whole, d] : users(p.first_use)) by_region_[next[d]++] = p.ends;
  std::sort(pieces_.begin(), pieces_.end(), [](const Piece& p, const Piece& q) { return p.ends < q.ends; });
}

}  // namespace clerestory
