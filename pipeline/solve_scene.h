#pragma once
// The library's front door: a scene and what is asked of it in, the light on its surfaces out.

#include "pipeline/observer.h"
#include "pipeline/solved.h"

namespace clerestory {

/// surfaces -> patches -> radiosity -> field on vertices and at sensors -> its measured error.
///
/// scene    from read_scene(), or made by the caller; it is not changed.
/// settings see settings_of(); the method is chosen by them.
/// throws   InputError when the scene cannot be solved: no light, nothing with an area, too little memory; the message
///          says what to do.
/// Stopped early by the observer or the time limit, it returns what is solved so far: Solved::solution.stop tells, and
/// Solved::empty() when that is nothing.
/// Threads: same bits for any thread count (set_thread_count()), but for a run that the time limit ends.
Solved solve_scene(const Scene& scene, const Settings& settings, Observer& observer);
/// The same with nobody watching.
Solved solve_scene(const Scene& scene, const Settings& settings = {});

}  // namespace clerestory
