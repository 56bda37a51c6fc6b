// clerestory formfactors, as a user runs it.

#include <gtest/gtest.h>

#include "tests/support/csv_rows.h"
#include "tests/support/run_program.h"

namespace clerestory {
namespace {

/// Unit floor and ceiling, and a plate half-way with a gap of 10 mm.
constexpr const char* kSlit = R"(
o floor
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
f -4 -3 -2 -1
o ceiling
v 0 0 1
v 0 1 1
v 1 1 1
v 1 0 1
f -4 -3 -2 -1
o plate
v -1 -1 0.5
v 0.3 -1 0.5
v 0.3 2 0.5
v -1 2 0.5
f -4 -3 -2 -1
v 0.31 -1 0.5
v 2 -1 0.5
v 2 2 0.5
v 0.31 2 0.5
f -4 -3 -2 -1
)";

TEST(FormFactors, PairsThatDidNotReachTheirErrorAreCountedAndTheWorstIsNamed) {
  const TempFolder folder;
  const std::string model = folder.write("slit.obj", kSlit), csv = folder / "F.csv";
  const ProgramRun few = run_program({"formfactors", model, "-o", csv, "--samples", "1024"});
  EXPECT_EQ(few.exit_code, 0) << few.err;
  EXPECT_NE(few.err.find("2 pairs of 9 pairs did not reach a standard error of 0.200 % of F"), std::string::npos)
      << few.err;
  EXPECT_NE(few.err.find("std_error says what was reached"), std::string::npos) << few.err;

  const ProgramRun enough = run_program({"formfactors", model, "-o", csv});
  EXPECT_EQ(enough.exit_code, 0) << enough.err;
  EXPECT_EQ(enough.err.find("did not reach"), std::string::npos) << enough.err;
  int blocked = 0;
  for (const auto& row : test::csv_rows(csv)) {
    const double F = std::stod(row.at("F")), std_error = std::stod(row.at("std_error"));
    EXPECT_LE(std_error, 0.002 * F) << row.at("from") << row.at("to");
    blocked += std_error > 0;
  }
  EXPECT_EQ(blocked, 2);
}

}  // namespace
}  // namespace clerestory
