#pragma once
// A part of a year <-> what its result holds beside the figures on points.

#include "solver/model/written_result.h"
#include "solver/model/year_part.h"

namespace clerestory {

/// Sets WrittenResult::year_part and year_tables. Of parts of one run year_part is the same text, and so are all tables
/// but those that is_of_one_part().
void add_year_part(const YearPart& part, WrittenResult& result);

/// throws  InputError when the result is no part, or its numbers do not fit it.
YearPart year_part_of(const WrittenResult& result);

/// throws  InputError that says which part, when the result is one: its arrays are whole only when it is merged.
void require_whole_year(const WrittenResult& result);

/// Whether that table has what differs from part to part.
bool is_of_one_part(const std::string& table);

}  // namespace clerestory
