// What pictures know besides their colours.
#include "radiosity/render.h"
#include "render/seen_points.h"

namespace radiosity {

std::vector<ImageLayer> pictureLayers(const PatchMesh& mesh, const Camera& camera,
                                      const RenderOptions& options, PictureParts parts) {
  ImageLayer depth{"depth", "m", {"Z"}, {}};
  ImageLayer normal{"normal", "", {"X", "Y", "Z"}, {}};
  ImageLayer patch{"patch", "", {}, {}};
  ImageLayer surface{"surface", "", {}, {}};
  for (const SeenPoint& seen : middlesOfPixels(mesh, camera, options)) {
    const bool hit = seen.patch != kNone;
    const Vec3 n = !hit        ? Vec3(0.0)
                   : seen.back ? -mesh.normal[seen.patch]
                               : mesh.normal[seen.patch];
    depth.values.push_back(float(seen.depth));
    for (int axis = 0; axis < 3; ++axis) normal.values.push_back(float(n[axis]));
    patch.values.push_back(hit && !seen.back ? float(seen.patch) : -1.0F);
    surface.values.push_back(hit ? float(mesh.surface[seen.patch]) : -1.0F);
  }
  const std::vector<std::string> colours = {"R", "G", "B"};
  std::vector<ImageLayer> layers;
  for (ImageLayer* layer : {&depth, &normal, &patch, &surface}) layers.push_back(std::move(*layer));
  layers.push_back({"albedo", "", colours, std::move(parts.albedo)});
  layers.push_back({"direct", "W/m^2/sr", colours, std::move(parts.direct)});
  layers.push_back({"indirect", "W/m^2/sr", colours, std::move(parts.indirect)});
  if (!parts.error.empty()) layers.push_back({"error", "", {}, std::move(parts.error)});
  return layers;
}

}  // namespace radiosity
