// Long calls: they release Python's lock and handle its signals.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>

#include "radiosity/base.h"

namespace radiosity::python {

/// Runs `work` on another thread, while this one waits without Python's lock. Every 50 ms the
/// waiting thread lets Python handle signals, so that Ctrl-C cancels the work and raises
/// KeyboardInterrupt. It also calls report(stage, done, total, steps), unless `report` is None; an
/// exception from it cancels the work, too. Errors of the work are thrown here. `work` must not
/// touch Python objects.
void runLong(const pybind11::object& report, const std::function<void(Progress&)>& work);

/// Like runLong(), on the calling thread, for work that takes at most a few tenths of a second from
/// one of its steps (Progress::advance()) to the next: handing a solve of milliseconds to
/// another thread would cost more than 1% of it. Signals and reports are looked at between steps,
/// which `work` must not make in parallel tasks.
void runShortSteps(const pybind11::object& report, const std::function<void(Progress&)>& work);

/// Like runLong(), for work that has no steps at which it could end, such as reading a file. Ctrl-C
/// raises KeyboardInterrupt at once; the work goes on to its end without effect. So `work` must own
/// all that it touches.
void runWithoutSteps(const std::function<void()>& work);

/// Work that other threads still do when Python ends is cancelled then, and waited for. Call it
/// once.
void endWorkWithProcess();

}  // namespace radiosity::python
