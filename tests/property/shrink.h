// A smaller scene with the same fault.
#pragma once

#include <string>

#include "model.h"

namespace radiosity::property {

/// Leaves out faces, and asks for fewer patches, as long as the fault `what` stays; up to about
/// `seconds`. Writes its trials to PATH.obj.
Model shrunk(Model model, const std::string& what, const std::string& path, double seconds);

}  // namespace radiosity::property
