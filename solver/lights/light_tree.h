#pragma once
// Lights in a tree: those that matter at a point are found without looking at all of them.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "solver/model/box.h"
#include "solver/model/vec.h"

namespace clerestory {

/// What the tree knows of a light.
struct LightBounds {
  Vec3 lower, upper;  ///< box around it [m]
  Vec3 axis;          ///< unit, middle of the directions it shines to; zero for all directions alike
  double cone = 0;    ///< half-angle around the axis of what is as strong as the axis [rad]; pi for all directions
  double power = 0;   ///< flux [W] or intensity [W/sr], one of them for a whole tree; > 0
  std::optional<Box> reach{};  ///< where it is asked for at all; none: everywhere. Of all lights of a tree, or of none
};

/// Beyond its cone a light falls off with the cosine (a surface that glows) or gives nothing (a spot).
enum class Falloff { cosine, none };

/// Tree of four children a node. At a receiver point p with normal n a child is chosen in proportion to
///   power * (bound of cos at p) * (bound of cos at the light) / max(d^2, size^2)
/// down to one light. A light has probability 0 only where it cannot shine on p's plane, or p is out of its reach.
/// Cost: building O(m log m); choosing and probability() O(log m). 90 bytes a light.
/// Source: Conty Estevez & Kulla, "Importance sampling of many lights with adaptive tree splitting", 2018; the bounds
/// are of boxes here and not of spheres, so that lights in the plane of the receiver weigh nothing.
class LightTree {
  using Lanes [[gnu::vector_size(16)]] = float;
  struct Shares {
    Lanes of_child;
    double sum;
  };

 public:
  struct Choice {
    std::uint32_t light = kNone;
    double probability = 0;
  };
  static constexpr std::uint32_t kNone = 0xffffffff;

  LightTree() = default;
  /// extent  length that the scene and its receivers are of the order of [m]; coordinates are around the origin.
  LightTree(std::span<const LightBounds> lights, Falloff falloff, double extent);

  bool empty() const { return nodes_.empty(); }

  /// A receiver point, where much is asked of the tree: it keeps what nodes were found to give there. For one thread.
  class Receiver {
   public:
    Receiver(const LightTree& tree, const Vec3& point, const Vec3& normal);

    const Vec3 p, n;

   private:
    friend class LightTree;
    // The root and what is near it have places of their own, other nodes share the rest.
    static constexpr std::uint32_t kNearRoot = 16, kShared = 48;
    static std::size_t place(std::uint32_t node) { return node < kNearRoot ? node : kNearRoot + node % kShared; }

    float x_, y_, z_, nx_, ny_, nz_;
    mutable std::array<std::uint32_t, kNearRoot + kShared> node_;  ///< whose shares are kept
    mutable std::array<Shares, kNearRoot + kShared> shares_;
  };

  /// Light chosen by pick in [0, 1); none when no light can shine on p.
  Choice choose(const Receiver& at, double pick) const;
  /// Probability with which choose() takes `light`.
  double probability(std::uint32_t light, const Receiver& at) const;
  /// Whether any light can shine on p, as far as the children of the root tell.
  bool reaches(const Vec3& p, const Vec3& n) const;
  /// All lights, neighbours in space near each other.
  const std::vector<std::uint32_t>& order() const { return order_; }

 private:
  static constexpr std::size_t kWidth = 4;
  /// By child, in units of the extent. Float, four at a time: choosing must cost less than the ray it saves.
  struct Node {
    Lanes centre_x, centre_y, centre_z, half_x, half_y, half_z, axis_x, axis_y, axis_z;
    Lanes cos_cone, sin_cone, size2, power;
    std::array<std::uint32_t, kWidth> child;  ///< node, or light with kLeaf
  };
  struct Builder;
  static constexpr std::uint32_t kLeaf = 0x80000000;

  /// Boxes around what the children reach.
  struct Reach {
    Lanes lower_x, lower_y, lower_z, upper_x, upper_y, upper_z;
  };

  Lanes importance(std::uint32_t node, const Receiver& at) const;
  const Shares& shares(std::uint32_t node, const Receiver& at) const;

  std::vector<Node> nodes_;
  std::vector<Reach> reach_;                  ///< by node; empty: everywhere
  std::vector<std::uint32_t> slot_of_node_;   ///< 4 * parent + which child
  std::vector<std::uint32_t> slot_of_light_;  ///< the same for lights
  std::vector<std::uint32_t> order_;
  Falloff falloff_ = Falloff::cosine;
  double scale_ = 1;  ///< 1 / extent
};

}  // namespace clerestory
