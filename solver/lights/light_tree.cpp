#include "solver/lights/light_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace clerestory {
namespace {

/// Sums over a group of lights, and what the group costs where it is taken for one light: its power, spread over its
/// size and over the directions it shines to. Those are pi when all face one way and 4 pi when they face all ways.
struct Group {
  Box box;
  double power = 0;
  Vec3 facing;  ///< sum of power * axis
  std::size_t count = 0;

  void add(const LightBounds& light) {
    box.add({light.lower, light.upper});
    power += light.power;
    facing += light.axis * light.power;
    ++count;
  }
  void add(const Group& g) {
    if (g.count == 0) return;
    box.add(g.box);
    power += g.power;
    facing += g.facing;
    count += g.count;
  }
  double cost() const {
    const Vec3 size = box.upper - box.lower;
    return power > 0 ? (4 * power - 3 * length(facing)) * dot(size, size) : 0.0;
  }
};

struct Range {
  std::uint32_t begin = 0, end = 0;
  Group group;
  std::uint32_t count() const { return end - begin; }
};

}  // namespace

struct LightTree::Builder {
  std::span<const LightBounds> lights;
  LightTree& tree;
  double total = 0;

  const LightBounds& at(std::uint32_t place) const { return lights[tree.order_[place]]; }
  static double middle(const LightBounds& light, int axis) { return (light.lower[axis] + light.upper[axis]) / 2; }

  Range range(std::uint32_t begin, std::uint32_t end) const {
    Range r{begin, end, {}};
    for (std::uint32_t i = begin; i < end; ++i) r.group.add(at(i));
    return r;
  }

  /// Both sides of the cheapest of the planes that cut the middles of the lights into 16 slices along an axis.
  std::array<Range, 2> halves(const Range& whole) {
    constexpr int kBins = 16;
    Box middles;
    for (std::uint32_t i = whole.begin; i < whole.end; ++i) {
      const Vec3 m = (at(i).lower + at(i).upper) / 2;
      middles.add(m);
    }
    const auto bin = [&](const LightBounds& light, int axis) {
      const double extent = middles.upper[axis] - middles.lower[axis];
      return std::clamp(static_cast<int>(kBins * (middle(light, axis) - middles.lower[axis]) / extent), 0, kBins - 1);
    };
    double best = std::numeric_limits<double>::infinity();
    int best_axis = -1, best_bin = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(middles.upper[axis] > middles.lower[axis])) continue;
      std::array<Group, kBins> slice;
      for (std::uint32_t i = whole.begin; i < whole.end; ++i)
        slice[static_cast<std::size_t>(bin(at(i), axis))].add(at(i));
      std::array<double, kBins> above{};  // cost of the slices from this one on
      Group side;
      for (std::size_t k = kBins - 1; k > 0; --k) {
        side.add(slice[k]);
        above[k] = side.cost();
      }
      side = {};
      for (std::size_t k = 1; k < kBins; ++k) {
        side.add(slice[k - 1]);
        if (side.count == 0 || side.count == whole.count()) continue;
        if (const double cost = side.cost() + above[k]; cost < best)
          best = cost, best_axis = axis, best_bin = static_cast<int>(k);
      }
    }
    std::uint32_t cut = whole.begin + whole.count() / 2;  // lights in one place are told apart by number
    if (best_axis >= 0) {
      const auto first = tree.order_.begin() + whole.begin, last = tree.order_.begin() + whole.end;
      const auto below =
          std::partition(first, last, [&](std::uint32_t l) { return bin(lights[l], best_axis) < best_bin; });
      cut = static_cast<std::uint32_t>(below - tree.order_.begin());
    }
    return {range(whole.begin, cut), range(cut, whole.end)};
  }

  void fill(Node& node, std::size_t k, const Range& r) const {
    const Vec3 lower = r.group.box.lower * tree.scale_, upper = r.group.box.upper * tree.scale_;
    const Vec3 centre = (lower + upper) / 2, half = (upper - lower) / 2;
    // Rounding to float, here and of the receiver, must not hide a light behind the receiver's plane.
    const double margin = 2e-7 * (1 + std::max({std::abs(centre.x), std::abs(centre.y), std::abs(centre.z)}));
    const auto f = [](double x) { return static_cast<float>(x); };
    node.centre_x[k] = f(centre.x), node.centre_y[k] = f(centre.y), node.centre_z[k] = f(centre.z);
    node.half_x[k] = f(half.x + margin), node.half_y[k] = f(half.y + margin), node.half_z[k] = f(half.z + margin);
    node.size2[k] = f(std::max(dot(half, half), 1e-13));
    // No light may drop out of the range of float.
    node.power[k] = f(std::max(r.group.power / total, 1e-20));
    const Vec3 axis = normalized(r.group.facing);
    double cone = length(r.group.facing) > 1e-6 * r.group.power ? 0 : std::numbers::pi;
    for (std::uint32_t i = r.begin; i < r.end && cone < std::numbers::pi; ++i)
      cone = std::max(cone, at(i).cone + std::acos(std::clamp(dot(axis, at(i).axis), -1.0, 1.0)));
    node.axis_x[k] = f(axis.x), node.axis_y[k] = f(axis.y), node.axis_z[k] = f(axis.z);
    cone = std::min(cone + 1e-6, std::numbers::pi);
    node.cos_cone[k] = cone < std::numbers::pi - 1e-5 ? f(std::cos(cone)) : -2.0f;
    node.sin_cone[k] = f(std::sin(cone));
  }

  void fill(Reach& reach, std::size_t k, const Range& r) const {
    Box box;
    for (std::uint32_t i = r.begin; i < r.end; ++i) box.add(*at(i).reach);
    const Vec3 lower = box.lower * tree.scale_, upper = box.upper * tree.scale_;
    const auto f = [](double x) { return static_cast<float>(x); };
    reach.lower_x[k] = f(lower.x), reach.lower_y[k] = f(lower.y), reach.lower_z[k] = f(lower.z);
    reach.upper_x[k] = f(upper.x), reach.upper_y[k] = f(upper.y), reach.upper_z[k] = f(upper.z);
  }

  void build() {
    struct Task {
      std::uint32_t node;
      Range range;
    };
    std::vector<Task> tasks{{0, range(0, static_cast<std::uint32_t>(lights.size()))}};
    tree.nodes_.emplace_back();
    tree.slot_of_node_.push_back(kNone);
    while (!tasks.empty()) {
      const Task task = std::move(tasks.back());
      tasks.pop_back();
      std::vector<Range> parts{task.range};
      while (parts.size() < kWidth) {
        const auto worst = std::max_element(parts.begin(), parts.end(), [](const Range& a, const Range& b) {
          return std::pair(a.count() > 1, a.group.cost()) < std::pair(b.count() > 1, b.group.cost());
        });
        if (worst->count() < 2) break;
        const auto [low, high] = halves(*worst);
        *worst = low;
        parts.insert(worst + 1, high);
      }
      Node node{};
      node.size2 += 1.0f;  // children that are missing have no power, and no 0 / 0 either
      Reach reach{};
      for (std::size_t k = 0; k < parts.size(); ++k) {
        fill(node, k, parts[k]);
        if (lights.front().reach) fill(reach, k, parts[k]);
        const auto slot = static_cast<std::uint32_t>(task.node * kWidth + k);
        if (parts[k].count() == 1) {
          const std::uint32_t light = tree.order_[parts[k].begin];
          node.child[k] = light | kLeaf;
          tree.slot_of_light_[light] = slot;
        } else {
          node.child[k] = static_cast<std::uint32_t>(tree.nodes_.size());
          tasks.push_back({node.child[k], parts[k]});
          tree.nodes_.emplace_back();
          tree.slot_of_node_.push_back(slot);
        }
      }
      tree.nodes_[task.node] = node;
      if (!lights.front().reach) continue;
      tree.reach_.resize(tree.nodes_.size());
      tree.reach_[task.node] = reach;
    }
  }
};

LightTree::LightTree(std::span<const LightBounds> lights, Falloff falloff, double extent)
    : slot_of_light_(lights.size()), order_(lights.size()), falloff_(falloff), scale_(extent > 0 ? 1 / extent : 1.0) {
  if (lights.empty()) return;
  Builder builder{lights, *this};
  for (std::size_t i = 0; i < lights.size(); ++i) {
    order_[i] = static_cast<std::uint32_t>(i);
    builder.total += lights[i].power;
  }
  builder.build();
}

LightTree::Receiver::Receiver(const LightTree& tree, const Vec3& point, const Vec3& normal)
    : p(point),
      n(normal),
      x_(static_cast<float>(p.x * tree.scale_)),
      y_(static_cast<float>(p.y * tree.scale_)),
      z_(static_cast<float>(p.z * tree.scale_)),
      nx_(static_cast<float>(n.x)),
      ny_(static_cast<float>(n.y)),
      nz_(static_cast<float>(n.z)) {
  node_.fill(kNone);
}

LightTree::Lanes LightTree::importance(std::uint32_t number, const Receiver& at) const {
  const Node& node = nodes_[number];
  // Grazing light is rare and not nothing; rounding may also find it too weak.
  constexpr float kGrazing = 1e-4f;
  const Lanes none{}, one = none + 1.0f, tiny = none + 1e-14f, grazing = none + kGrazing;
  const auto larger = [](Lanes a, Lanes b) { return a > b ? a : b; };
  const auto smaller = [](Lanes a, Lanes b) { return a < b ? a : b; };
  const auto magnitude = [&](Lanes a) { return larger(a, -a); };
  const auto root = [](Lanes a) { return Lanes{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])}; };

  const Lanes dx = node.centre_x - at.x_, dy = node.centre_y - at.y_, dz = node.centre_z - at.z_;
  const Lanes &hx = node.half_x, &hy = node.half_y, &hz = node.half_z;
  const Lanes &ax = node.axis_x, &ay = node.axis_y, &az = node.axis_z;
  const Lanes ux = magnitude(dx), uy = magnitude(dy), uz = magnitude(dz);
  const Lanes ex = larger(ux - hx, none), ey = larger(uy - hy, none), ez = larger(uz - hz, none);
  const Lanes d2 = dx * dx + dy * dy + dz * dz, nearest2 = larger(ex * ex + ey * ey + ez * ez, tiny);
  const Lanes farthest2 = (ux + hx) * (ux + hx) + (uy + hy) * (uy + hy) + (uz + hz) * (uz + hz);
  // Of the box's highest corner above the receiver's plane, and of p along the axis above the box's lowest corner.
  const Lanes height_p =
      at.nx_ * dx + at.ny_ * dy + at.nz_ * dz + std::abs(at.nx_) * hx + std::abs(at.ny_) * hy + std::abs(at.nz_) * hz;
  const Lanes height_q = magnitude(ax) * hx + magnitude(ay) * hy + magnitude(az) * hz - (ax * dx + ay * dy + az * dz);

  const Lanes cos_p = smaller(height_p / root(nearest2), one);
  // Below the axis's plane the largest cosine, the least negative one, is that of the farthest corner.
  const Lanes off_axis =
      larger(smaller(height_q / root(height_q > none ? nearest2 : larger(farthest2, tiny)), one), -one);
  Lanes cos_q = none;
  if (falloff_ == Falloff::cosine)
    cos_q = off_axis * node.cos_cone + root(one - off_axis * off_axis) * node.sin_cone;  // of the angle beyond the cone
  cos_q = off_axis >= node.cos_cone ? one : cos_q;

  const Lanes value = node.power * larger(cos_p, grazing) * larger(cos_q, grazing) / larger(d2, node.size2);
  const Lanes found = (height_p > none) & (cos_q > none) ? value : none;
  if (reach_.empty()) return found;
  const Reach& reach = reach_[number];
  const Lanes x = none + at.x_, y = none + at.y_, z = none + at.z_;
  return (x >= reach.lower_x) & (x <= reach.upper_x) & (y >= reach.lower_y) & (y <= reach.upper_y) &
                 (z >= reach.lower_z) & (z <= reach.upper_z)
             ? found
             : none;
}

const LightTree::Shares& LightTree::shares(std::uint32_t node, const Receiver& at) const {
  const std::size_t place = Receiver::place(node);
  Shares& kept = at.shares_[place];
  if (at.node_[place] != node) {
    const Lanes share = importance(node, at);
    kept = {share, static_cast<double>(share[0]) + share[1] + share[2] + share[3]};
    at.node_[place] = node;
  }
  return kept;
}

LightTree::Choice LightTree::choose(const Receiver& at, double pick) const {
  if (empty()) return {};
  Choice choice{0, 1};
  while (true) {
    const Node& node = nodes_[choice.light];
    const auto& [share, sum] = shares(choice.light, at);
    if (!(sum > 0)) return {};
    double left = pick * sum;
    std::size_t k = kWidth;
    for (std::size_t i = 0; i < kWidth; ++i) {  // rounding may leave a rest: it goes to the last that has a share
      if (!(share[i] > 0)) continue;
      if (k < kWidth) left -= share[k];
      k = i;
      if (left < share[i]) break;
    }
    pick = std::clamp(left / share[k], 0.0, 1 - 0x1p-53);
    choice.probability *= share[k] / sum;
    choice.light = node.child[k];
    if (choice.light & kLeaf) break;
  }
  choice.light &= ~kLeaf;
  return choice;
}

double LightTree::probability(std::uint32_t light, const Receiver& at) const {
  double probability = 1;
  for (std::uint32_t slot = slot_of_light_[light]; slot != kNone; slot = slot_of_node_[slot / kWidth]) {
    const auto& [share, sum] = shares(slot / kWidth, at);
    if (!(share[slot % kWidth] > 0)) return 0;
    probability *= share[slot % kWidth] / sum;
  }
  return probability;
}

bool LightTree::reaches(const Vec3& p, const Vec3& n) const {
  if (empty()) return false;
  const Lanes share = importance(0, {*this, p, n});
  return share[0] > 0 || share[1] > 0 || share[2] > 0 || share[3] > 0;
}

}  // namespace clerestory
