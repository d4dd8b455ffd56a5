// Which outputs show light at elements, and which keep it.
#pragma once

#include "cli/outputs.h"
#include "cli/request.h"

namespace radiosity::cli {

/// What --elements asks for, with the outputs there are.
struct ElementUse {
  bool shown = false;  ///< pictures and lit meshes show elements, not patches
  bool all = false;    ///< of all patches: for a lit mesh or a page, or to be kept
};

/// Of solve, render and view. Shown by default; a results file alone keeps them where asked for.
/// Errors: InputError where they were asked for, or their tolerance was, and no output has them.
ElementUse elementUse(const Request& request, const OutputSet& files);

}  // namespace radiosity::cli
