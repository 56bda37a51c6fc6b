#pragma once
// Where an error is looked at: random points of the surfaces, spread over the rooms.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/model/patch_set.h"

namespace clerestory {

inline constexpr double kLargeRoom = 0.01;  ///< share of all area from which on a room counts by itself

struct PointInRoom {
  std::size_t patch;
  std::uint32_t room;
  double weight;  ///< the area it stands for, in proportion
  double u, v;    ///< of point_on_triangle()
};

/// Patches one after another, room after room, each as long as its chance to be looked at: a third of the looks go by
/// area, a third by its root, and a third to each large room alike. Patches without rooms are one room. Inside of a
/// room two thirds of the looks go by area, and a third to where light changes within patches: a bright spot on a
/// hundredth of the area may be all of an error.
class PointsByRoom {
 public:
  /// patches  are kept by reference.
  /// change   by patch, how much light changes within it, in any unit; empty: not known.
  explicit PointsByRoom(const PatchSet& patches, std::span<const double> change = {});

  double total() const { return total_; }  ///< 0: nothing has an area
  std::size_t large_rooms() const { return large_rooms_; }
  const std::vector<double>& areas() const { return areas_; }  ///< by room [m2]
  /// `count` of them, stratified: one in each of so many stretches alike.
  std::vector<PointInRoom> points(std::size_t count, std::uint64_t key) const;

 private:
  const PatchSet& patches_;
  std::vector<std::uint32_t> order_;
  std::vector<double> cumulative_, weight_;  ///< by patch in that order
  std::vector<double> areas_;                ///< by room
  double total_ = 0;
  std::size_t large_rooms_ = 0;
};

}  // namespace clerestory
