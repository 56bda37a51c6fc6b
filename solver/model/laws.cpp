#include "solver/model/laws.h"

#include <cmath>
#include <limits>
#include <utility>

namespace clerestory {

double share_of_bound(const LawInRoom& room) {
  if (!std::isfinite(room.worst)) return std::numeric_limits<double>::infinity();
  if (room.worst == 0) return 0;
  return room.bound > 0 ? room.worst / room.bound : std::numeric_limits<double>::infinity();
}

const LawInRoom* LawCheck::worst() const {
  const LawInRoom* worst = nullptr;
  for (const LawInRoom& room : rooms)
    if (room.resolved && (!worst || share_of_bound(room) > share_of_bound(*worst))) worst = &room;
  return worst;
}

WorstInRooms::WorstInRooms(std::vector<std::string> names) {
  if (names.empty()) names.push_back("scene");
  rooms_.resize(names.size());
  seen_.resize(names.size());
  for (std::size_t r = 0; r < names.size(); ++r) rooms_[r].room = std::move(names[r]);
}

void WorstInRooms::see(std::size_t room, double off, double bound, bool resolved) {
  const LawInRoom found{rooms_[room].room, off, bound, resolved};
  // What is resolved tells more than what is not.
  const bool first = !seen_[room] || (resolved && !rooms_[room].resolved);
  if (!first && (!resolved || share_of_bound(found) <= share_of_bound(rooms_[room]))) return;
  rooms_[room] = found;
  seen_[room] = true;
}

std::vector<LawInRoom> WorstInRooms::rooms() const {
  std::vector<LawInRoom> seen;
  for (std::size_t r = 0; r < rooms_.size(); ++r)
    if (seen_[r]) seen.push_back(rooms_[r]);
  return seen;
}

}  // namespace clerestory
