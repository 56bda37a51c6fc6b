#include "solver/model/parallel.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <new>
#include <stdexcept>
#include <string_view>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#ifdef CLERESTORY_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>

/// What libraries do that were not compiled for the thread sanitizer does not count.
extern "C" const char* __tsan_default_options() { return "ignore_noninstrumented_modules=1"; }
#endif

namespace clerestory {
namespace {

std::unique_ptr<tbb::global_control> limit;

/// Work that one thread hands over to others. TBB orders their accesses; the thread sanitizer cannot see into it, and
/// is told here.
struct Handover {
#ifdef CLERESTORY_THREAD_SANITIZER
  void give() { __tsan_release(this); }
  void take() { __tsan_acquire(this); }
#else
  void give() {}
  void take() {}
#endif
};

}  // namespace

void set_thread_count(int threads) {
  limit.reset();
  if (threads > 0)
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                  static_cast<std::size_t>(threads));
}

void on_one_thread(const std::function<void()>& body) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  body();
}

void parallel_for(std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  if (n == 0) return;
  Handover start, end;
  start.give();
  try {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, n, grain),
        [&](const auto& range) {
          start.take();
          body(range.begin(), range.end());
          end.give();
        },
        tbb::simple_partitioner());
  } catch (const std::runtime_error& e) {
    // TBB says this, and nothing more exact, when there is no memory for the stack of a thread.
    if (std::string_view(e.what()).starts_with("pthread_create")) throw std::bad_alloc();
    throw;
  }
  end.take();
}

Blocks parallel_blocks(std::size_t n, std::size_t block, std::size_t grain, std::string_view stage,
                       const Monitor& monitor,
                       const std::function<unsigned long long(std::size_t, std::size_t)>& body) {
  std::atomic<unsigned long long> rays = 0;
  std::size_t done = 0;
  while (done < n && !monitor.should_stop()) {
    monitor.report(stage, static_cast<double>(done) / static_cast<double>(n));
    const std::size_t count = std::min(block, n - done);
    parallel_for(count, grain, [&](std::size_t from, std::size_t to) {
      if (!monitor.should_stop()) rays += body(done + from, done + to);
    });
    if (monitor.should_stop()) break;
    done += count;
  }
  return {done, rays};
}

}  // namespace clerestory
