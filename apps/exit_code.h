#pragma once
// What the program tells the shell.

namespace clerestory {

enum ExitCode {
  kDone = 0,
  kInternalFailure = 1,
  kWrongUsage = 2,
  kInputRefused = 3,        ///< or an output that cannot be written, or out of memory
  kAccuracyNotReached = 4,  ///< the result was written coarser than asked for, or time was up before there was one
  kInterrupted = 5,         ///< what was solved so far was written, if anything was
};

}  // namespace clerestory
