// A scene file becomes a picture: scene_to_picture SCENE PICTURE
#include <radiosity/radiosity.h>

#include <cstdio>

using namespace radiosity;

int main(int, char** arguments) try {
  Progress quiet;
  const Scene scene = loadScene(arguments[1]);
  MeshOptions mesh_options;
  mesh_options.patches = 500;
  const PatchMesh mesh = meshScene(scene, mesh_options, quiet).mesh;
  const FormFactors factors = computeFormFactors(mesh, {}, quiet);
  const Solution light = solve(factors, patchMaterials(scene, mesh), mesh, {}, quiet);
  std::printf("%s\n", light.summary.message.c_str());
  const Camera camera =
      scene.cameras.empty() ? framingCamera(mesh, factors.report.closed, 1) : scene.cameras.front();
  RenderOptions picture;
  picture.width = picture.height = 64;
  const Image image = renderRadiance(mesh, light.radiosity, {}, camera, picture, quiet);
  writeImage(arguments[2], exposed(image, autoExposure(image)), false);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
