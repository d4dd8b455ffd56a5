// Calls that may take long: without Python's lock, with its signals.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>

#include "radiosity/base.h"

namespace radiosity::python {

/// Runs `work` on another thread, while this one waits without Python's lock. Every 50 ms the
/// waiting thread lets Python handle signals, so that Ctrl-C cancels the work and raises
/// KeyboardInterrupt, and calls report(stage, done, total, steps), unless that is None; what it
/// raises cancels the work, too. Errors of the work are thrown here. `work` must touch no Python
/// object.
void runLong(const pybind11::object& report, const std::function<void(Progress&)>& work);

}  // namespace radiosity::python
