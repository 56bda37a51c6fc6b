#pragma once
// What the program tells the shell.

namespace clerestory {

enum ExitCode {
  kDone = 0,
  kInternalFailure = 1,
  kWrongUsage = 2,
  kInputRefused = 3,
  kAccuracyNotReached = 4,  ///< the result was written, but it is coarser than asked for, or time ran out
  kInterrupted = 5,         ///< what was solved so far was written
};

}  // namespace clerestory
