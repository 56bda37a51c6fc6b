#pragma once
// What the program finds for the rows of one scene.

#include <vector>

#include "tests/cases/case_folder.h"

namespace clerestory::test {

/// In the order of the rows, in their unit. Rows with a point are sensors, where `lux` of case.txt is a value of 1;
/// rows in lumens are flux on the surfaces whose names begin with the row's point, E_indirect is what is there beside
/// the direct light of 10,000 lm, and other rows are the share of these 10,000 lm that arrives anywhere. throws
/// std::runtime_error with what the program said where it fails.
std::vector<double> solve_case(const CaseFolder& folder, const CaseScene& scene);

}  // namespace clerestory::test
