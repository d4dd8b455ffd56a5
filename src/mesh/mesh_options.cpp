#include "base/option_list.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

void MeshOptions::validate() const { requireRanges(*this); }

}  // namespace radiosity
