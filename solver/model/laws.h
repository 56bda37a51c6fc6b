#pragma once
// What a check of a result against the laws of radiosity found.

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace clerestory {

enum class Law {
  reciprocity,        ///< A_i F_ij = A_j F_ji
  row_sums,           ///< what leaves a surface arrives or is lost: sum_j F_ij + lost_i = 1
  no_negative_light,  ///< E >= 0
  radiosity,          ///< B = M + rho E
  energy              ///< what arrives in a room is what is sent there; all in all, emitted = absorbed + escaped
};
inline constexpr std::array<std::string_view, 5> kLawNames{"reciprocity", "row_sums", "no_negative_light", "radiosity",
                                                           "energy"};  // as in Law

/// Of all places in a room the one that is farthest off for what may be.
struct LawInRoom {
  std::string room;
  double worst = 0;      ///< how far off, relative; the law says of what [1]
  double bound = 0;      ///< how far it may be: what the accuracy stands for and what rays leave open [1]
  bool resolved = true;  ///< false: too few rays tell of it; it says nothing

  /// Not of what is no number.
  bool holds() const { return !resolved || worst <= bound; }
};

struct LawCheck {
  Law law = Law::energy;
  std::vector<LawInRoom> rooms;  ///< those that it has a meaning in
  std::string not_checked;       ///< why not; empty: it was

  bool holds() const { return std::ranges::all_of(rooms, &LawInRoom::holds); }
  /// The room that is farthest off for what may be; null where none is resolved.
  const LawInRoom* worst() const;
};

/// How far off for what may be: above 1 the law is broken; infinite for what is no number.
double share_of_bound(const LawInRoom& room);

/// Keeps the worst place of each room.
class WorstInRooms {
 public:
  /// names  of the rooms; empty: there is one, "scene".
  explicit WorstInRooms(std::vector<std::string> names);
  void see(std::size_t room, double off, double bound, bool resolved = true);
  /// Rooms that were seen, in order.
  std::vector<LawInRoom> rooms() const;

 private:
  std::vector<LawInRoom> rooms_;
  std::vector<bool> seen_;
};

}  // namespace clerestory
