// Triangles of one's own, each a patch, become form factors: two unit squares that face each other
// at a distance of 1.
#include <radiosity/radiosity.h>

#include <array>
#include <cstdio>

using namespace radiosity;

int main() try {
  const Vec3 vertices[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                           {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  const std::array<Index, 3> triangles[] = {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}};
  Material grey;
  grey.name = "grey";
  Progress quiet;
  MeshOptions as_given;
  as_given.faces_as_patches = true;
  const Scene scene = sceneOfTriangles(vertices, triangles, {&grey, 1});
  const PatchMesh mesh = meshScene(scene, as_given, quiet).mesh;
  const FormFactors factors = computeFormFactors(mesh, {}, quiet);
  const ExchangeOperator& f = *factors.matrix;
  const double lower_to_upper = 0.5 * (f.at(0, 2) + f.at(0, 3) + f.at(1, 2) + f.at(1, 3));
  std::printf("%.6f\n", lower_to_upper);  // Howell C-11: 0.199825
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
