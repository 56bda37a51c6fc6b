#include "solver/hierarchy/cut_row.h"

#include <algorithm>
#include <cmath>

namespace clerestory {
namespace {

constexpr double kMostOwed = 0.1;        // of the limit for one link: a row may not drift by more while it is cut
constexpr std::size_t kMostLinks = 192;  // of a row; more are merged, whatever the limit says
constexpr double kMostGrowth = 64;       // of the limit for that; beyond, the row is as long as it is

/// Links for the hits of one row.
class Cut {
 public:
  Cut(const ElementTree& tree, const NodeLight& nodes, double limit, double most_owed, std::vector<Link>& out)
      : tree_(tree), nodes_(nodes), limit_(limit), most_owed_(most_owed), out_(out) {}

  /// For hits that are all under node v.
  void under(std::uint32_t v, std::span<const Arrival> hits) {
    double weight = 0;
    for (const Arrival& a : hits) weight += a.weight;
    if (tree_.is_leaf(v) || takes_all(v, weight, hits))
      out_.push_back({v, static_cast<float>(weight)});
    else if (hits.front().node == hits.back().node)
      out_.push_back({hits.front().node, static_cast<float>(weight)});
    else
      under_children_of(v, hits);
  }

  /// What the links so far bring too much, by what their hits found [W/m2].
  double owed() const { return owed_; }

 private:
  bool takes_all(std::uint32_t v, double weight, std::span<const Arrival> hits) {
    if (!(limit_ > 0) || !(weight * nodes_.deviation[v] <= limit_)) return false;
    double light = 0;
    for (const Arrival& a : hits) light += a.weight * nodes_.mean[a.node];
    const double more = owed_ + weight * nodes_.mean[v] - light;
    if (!(std::abs(more) <= most_owed_)) return false;
    owed_ = more;
    return true;
  }

  void under_children_of(std::uint32_t v, std::span<const Arrival> hits) {
    for (std::uint32_t child = v + 1; !hits.empty(); child = tree_.end[child]) {
      std::size_t count = 0;
      while (count < hits.size() && hits[count].node < tree_.end[child]) ++count;
      if (count == 0) continue;
      under(child, hits.first(count));
      hits = hits.subspan(count);
    }
  }

  const ElementTree& tree_;
  const NodeLight& nodes_;
  const double limit_, most_owed_;
  std::vector<Link>& out_;
  double owed_ = 0;
};

/// Nodes are a little darker than what is seen of them: their hidden parts lie in shadows. Some weight goes from the
/// darkest to the brightest source, so that the row brings what its rays found, and its sum stays.
void settle(double owed, const NodeLight& nodes, std::span<Link> links) {
  if (links.size() < 2 || owed == 0) return;
  const auto [low, high] = std::minmax_element(links.begin(), links.end(), [&](const Link& a, const Link& b) {
    return nodes.mean[a.source] < nodes.mean[b.source];
  });
  const double apart = nodes.mean[high->source] - nodes.mean[low->source];
  if (!(apart > 0)) return;
  const double most = 0.5 * std::min(low->weight, high->weight);
  const auto moved = static_cast<float>(std::clamp(owed / apart, -most, most));
  high->weight -= moved, low->weight += moved;
}

}  // namespace

void sort_for_cut(std::vector<Arrival>& arrivals) {
  std::sort(arrivals.begin(), arrivals.end(), [](const Arrival& a, const Arrival& b) {
    return a.part < b.part || (a.part == b.part && a.node < b.node);
  });
}

void cut_row(std::span<const Arrival> row, const ElementTree& tree, const NodeLight& nodes, double limit,
             std::vector<Link>& out) {
  if (row.empty()) return;
  const std::size_t before = out.size();
  for (double grown = limit;; grown *= 2) {
    Cut cut(tree, nodes, grown, kMostOwed * limit, out);  // what a row may owe does not grow
    cut.under(0, row);
    const bool fits = out.size() - before <= kMostLinks;
    if (fits || !(grown > 0) || !(grown < kMostGrowth * limit)) {
      settle(cut.owed(), nodes, std::span(out).subspan(before));
      return;
    }
    out.resize(before);
  }
}

}  // namespace clerestory
