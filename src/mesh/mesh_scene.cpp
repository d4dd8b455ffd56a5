#include "mesh/polygons/complex.h"

namespace radiosity {

MeshResult meshScene(const Scene& scene, const MeshOptions& options, Progress& progress) {
  options.validate();
  validate(scene);
  MeshResult result;
  if (options.faces_as_patches) {
    result.mesh = facesAsPatches(scene, options, result.report, progress);
  } else {
    const CoarseComplex complex = buildComplex(scene, options, result.report, progress);
    result.mesh = subdivide(complex, scene, options, result.report, progress);
  }
  result.mesh.enclosures = findEnclosures(result.mesh, progress);
  return result;
}

}  // namespace radiosity
