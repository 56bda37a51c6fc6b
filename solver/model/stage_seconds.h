#pragma once
// Where the time of a run went.

namespace clerestory {

/// [s]
struct StageSeconds {
  double read = 0, mesh = 0, build = 0, direct = 0, refine = 0, gather = 0, reconstruct = 0, measure = 0, write = 0,
         total = 0;
};

}  // namespace clerestory
