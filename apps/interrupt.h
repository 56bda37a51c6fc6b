#pragma once
// Signals ask for an end. What it costs decides how they are answered.

#include <atomic>
#include <chrono>

namespace clerestory {

/// From now on SIGINT, SIGTERM, SIGHUP and SIGXCPU (`ulimit -t`) end the program at once, whatever it does: it says so,
/// removes its temporary files and exits with kInterrupted. SIGPIPE and SIGXFSZ (`ulimit -f`) do nothing: the write
/// that they are about fails, and who writes says what it was.
const std::atomic<bool>& catch_signals();

/// From now on there is a result to lose: the first signal only sets the flag that catch_signals() returned, a second
/// one ends the program at once.
void keep_result_when_interrupted();

/// Ends the program with kAccuracyNotReached at that time, unless there is a result by then.
void end_without_result_at(std::chrono::steady_clock::time_point time);

/// Messages of an end at once go there, too.
void log_ends_to(int descriptor);

}  // namespace clerestory
