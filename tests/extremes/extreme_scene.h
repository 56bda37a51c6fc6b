#pragma once
// Scenes at the ends of what is allowed, solved by the program as a user runs it.

#include <map>
#include <string>
#include <vector>

#include "tests/support/model_text.h"
#include "tests/support/result_file.h"
#include "tests/support/run_program.h"

namespace clerestory::test {

struct Outcome {
  ProgramRun run;
  ResultFile result;
  std::vector<double> sensors_lux;
  /// A number of the field data: "energy.imbalance".
  double figure(const std::string& name) const { return result.numbers.at(name).values.at(0); }
  /// Mean irradiance by surface, weighted by area [W/m2], and its standard error where paths know it.
  struct Mean {
    double E = 0, std_error = 0;
  };
  std::map<std::string, Mean> by_surface() const;
  /// Largest irradiance of a cell [W/m2].
  double largest() const;
};

/// rest  of the scene file, behind its geometry. sensors: rows of x,y,z,nx,ny,nz.
Outcome solve_extreme(const std::string& obj, const std::string& rest, const std::vector<std::string>& options = {},
                      const std::string& sensors = {});

/// What holds of every scene: done, with --check: no law broken; only numbers, none of them below 0.
void expect_sound(const Outcome& outcome);

}  // namespace clerestory::test
