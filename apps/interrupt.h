#pragma once
// Ctrl-C asks for an end, it does not force one.

#include <atomic>

namespace clerestory {

/// From now on the first SIGINT or SIGTERM sets the flag returned; a second one ends the program at once.
const std::atomic<bool>& catch_interrupts();

}  // namespace clerestory
