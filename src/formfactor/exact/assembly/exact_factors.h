// The exact method: every pair once, area to area, with the blocked parts clipped off.
#pragma once

#include "formfactor/method.h"

namespace radiosity {

std::unique_ptr<PreparedMethod> prepareExact(const PatchMesh& mesh,
                                             const FormFactorOptions& options);

}  // namespace radiosity
