#include "page/eyes.h"

#include <vector>

#include "formfactor/hemicube/eye_frame.h"
#include "gather/eyes.h"
#include "page/surfaces.h"

namespace radiosity::page {

void addEyes(const PatchMesh& mesh, double crease, const Vec3& origin, Container& container) {
  GatherOptions options;
  options.crease = crease;
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<Vec3> axes;
  for (const Eye& eye : vertexEyes(mesh, cornerGroups(mesh, crease), options)) {
    positions.push_back(eye.position);
    normals.push_back(eye.looks ? eye.normal : Vec3(0.0));
    axes.push_back(eye.looks ? eyeFrame(eye.position, eye.normal, eye.angle).axes[0] : Vec3(0.0));
  }
  container.add("eye_position", packed(positions, origin));
  container.add("eye_normal", packed(normals));
  container.add("eye_axis", packed(axes));
}

}  // namespace radiosity::page
