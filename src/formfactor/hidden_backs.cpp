#include "formfactor/hidden_backs.h"

#include "mesh/patches/enclosures.h"

namespace radiosity {

HiddenBacks::HiddenBacks(const ViewScene& scene, const PatchMesh& mesh)
    : mesh_(mesh),
      enclosures_(enclosuresOf(mesh, found_)),
      covered_(scene.polygons.size()),
      surfaces_(enclosures_.surfaces.size()) {
  for (Index p = 0; p < scene.polygons.size(); ++p) {
    const Index source = scene.polygons[p].source;
    covered_[p] = enclosures_.covered[source];
    const Index surface = enclosures_.surface_of[source];
    if (surface != kNone) surfaces_[surface].push_back(p);
  }
}

void HiddenBacks::fromEye(const Vec3& eye, Index own, std::vector<std::uint8_t>& hidden) const {
  hidden = covered_;
  for (Index s = 0; s < surfaces_.size(); ++s) {
    const bool same = own != kNone && enclosures_.surface_of[own] == s;
    if (!same && !isOnFrontSide(mesh_, enclosures_.surfaces[s], eye)) continue;
    for (const Index p : surfaces_[s]) hidden[p] = 1;
  }
}

}  // namespace radiosity
