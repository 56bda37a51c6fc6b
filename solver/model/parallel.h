#pragma once
// Loops over all cores. TBB stays behind this header.

#include <cstddef>
#include <functional>
#include <string_view>

#include "solver/model/monitor.h"

namespace clerestory {

/// Threads used from now on by the whole process; 0 means all cores.
void set_thread_count(int threads);

/// Calls body() while nothing in the process uses more than one thread: for libraries whose parallel loops would leave
/// traces in the result.
void on_one_thread(const std::function<void()>& body);

/// Calls body(begin, end) for disjoint ranges that cover [0, n), at most `grain` long, on several threads. Bodies write
/// only to what their indices own, so the result does not depend on how ranges fall on threads.
void parallel_for(std::size_t n, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// The same in blocks of `block`, one after another; before each, progress of the stage is reported. The monitor is
/// asked before each range whether to go on; a block that it stopped does not count as done. Bodies return the rays
/// they sent.
struct Blocks {
  std::size_t done = 0;  ///< the first so many indices were visited; less than n: the monitor stopped it
  unsigned long long rays = 0;
};
Blocks parallel_blocks(std::size_t n, std::size_t block, std::size_t grain, std::string_view stage,
                       const Monitor& monitor,
                       const std::function<unsigned long long(std::size_t begin, std::size_t end)>& body);

}  // namespace clerestory
