#pragma once
// Which rooms of a result are rooms that people use.

#include <string>
#include <vector>

#include "solver/model/written_result.h"

namespace clerestory {

/// By room: not the outdoors, nor what a model calls a room though it lies under the sky, as a roof: with more than
/// half of the light of open ground in the mean, where that is known. Not "smaller spaces"; and where model or scene
/// name rooms, none without such a name: those are cavities. Pictures and pages look past all these. Where no room is
/// left, all but the outdoors are.
std::vector<bool> inner_rooms(const WrittenResult& result);
/// The same by their names alone.
std::vector<bool> inner_rooms(const std::vector<std::string>& rooms);

}  // namespace clerestory
