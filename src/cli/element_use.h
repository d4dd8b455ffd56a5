// Decides which outputs show light at elements and which keep it.
#pragma once

#include "cli/outputs.h"
#include "cli/request.h"

namespace radiosity::cli {

/// The meaning of --elements for the given outputs.
struct ElementUse {
  bool shown = false;  ///< pictures and lit meshes show elements, not patches
  bool all = false;    ///< of all patches: for a lit mesh or a page, or to be kept
};

/// The use of elements in solve, render and view. By default they are shown; a results file alone
/// only keeps them if asked to. Errors: InputError if elements or their tolerance were asked for
/// and no output has them.
ElementUse elementUse(const Request& request, const OutputSet& files);

}  // namespace radiosity::cli
