// Makes scenes in memory from triangles, and checks them.
#include <fmt/format.h>

#include <cmath>
#include <glm/vector_relational.hpp>
#include <set>
#include <string>

#include "base/finite.h"
#include "radiosity/scene.h"

namespace radiosity {
namespace {

class Validation {
 public:
  explicit Validation(const Scene& scene) : scene_(scene) {}

  void run() const {
    for (std::size_t k = 0; k < scene_.vertices.size(); ++k) {
      require(isFinite(scene_.vertices[k]), "vertex", k, "a coordinate is no finite number");
    }
    checkFaces();
    checkSurfaces();
    checkMaterials();
    checkTextures();
    checkLights();
  }

 private:
  void checkFaces() const {
    const std::size_t faces = scene_.faceCount();
    const std::vector<std::size_t>& offset = scene_.face_offset;
    require(offset.size() == faces + 1 || (faces == 0 && offset.empty()),
            fmt::format("{} faces need {} offsets, it has {}", faces, faces + 1, offset.size()));
    require(offset.empty() || offset.front() == 0, "its face_offset does not begin with 0");
    require(offset.empty() || offset.back() == scene_.corners.size(),
            "its face_offset does not end with the number of corners");
    const std::size_t texcoords = scene_.texcoords.size();
    require(texcoords == 0 || texcoords == scene_.corners.size(),
            "its texcoords are neither one a corner nor none");
    require(scene_.colours.empty() || scene_.colours.size() == scene_.corners.size(),
            "its colours are neither one a corner nor none");
    for (std::size_t k = 0; k < scene_.colours.size(); ++k) {
      const Vec3& c = scene_.colours[k];
      require(glm::all(glm::greaterThanEqual(c, Vec3(0.0))) &&
                  glm::all(glm::lessThanEqual(c, Vec3(1.0))),
              "corner", k, "its colour is outside 0 to 1");
    }
    for (std::size_t f = 0; f < faces; ++f) {
      require(offset[f] <= offset[f + 1], "face", f, "its offsets go down");
    }
    for (std::size_t f = 0; f < faces; ++f) checkFace(f);
  }

  void checkLights() const {
    for (const Light& light : scene_.lights) {
      require(light.strength.size() == 3,
              fmt::format("{} has {} values of {}, it takes 3", light.name, light.strength.size(),
                          light.traits().strength));
      light.validate();
      Light settled = light;
      settled.settle(scene_.up);
      require(settled == light,
              fmt::format("{} has angles, or no direction: settle() gives it one", light.name));
    }
  }

  void checkFace(std::size_t f) const {
    require(scene_.face_surface[f] < scene_.surfaces.size(), "face", f,
            fmt::format("there is no surface {}; there are {}", scene_.face_surface[f],
                        scene_.surfaces.size()));
    for (const Index v : scene_.face(f)) {
      require(v < scene_.vertices.size(), "face", f,
              fmt::format("there is no vertex {}; there are {}", v, scene_.vertices.size()));
    }
  }

  void checkSurfaces() const {
    std::set<std::string> names;
    for (std::size_t s = 0; s < scene_.surfaces.size(); ++s) {
      const Surface& surface = scene_.surfaces[s];
      require(names.insert(surface.name).second, "surface", s,
              fmt::format("another one is named '{}', too", surface.name));
      require(surface.material < scene_.materials.size(), "surface", s,
              fmt::format("there is no material {}; there are {}", surface.material,
                          scene_.materials.size()));
    }
  }

  void checkMaterials() const {
    for (std::size_t m = 0; m < scene_.materials.size(); ++m) {
      const Material& material = scene_.materials[m];
      for (int band = 0; band < 3; ++band) {
        const double rho = material.reflectance[band];
        const double emission = material.emission[band];
        require(rho >= 0 && rho <= 1, "material", m,
                fmt::format("its reflectance {} is not in [0, 1]", rho));
        require(emission >= 0 && std::isfinite(emission), "material", m,
                fmt::format("its emission {} is negative or no finite number", emission));
      }
      for (const Index texture : {material.texture, material.emission_texture}) {
        require(
            texture == kNone || texture < scene_.textures.size(), "material", m,
            fmt::format("there is no texture {}; there are {}", texture, scene_.textures.size()));
      }
    }
  }

  void checkTextures() const {
    for (std::size_t t = 0; t < scene_.textures.size(); ++t) {
      const Texture& texture = scene_.textures[t];
      const bool fits =
          texture.width > 0 && texture.height > 0 &&
          texture.texels.size() == std::size_t(texture.width) * std::size_t(texture.height) * 3;
      require(fits, "texture", t, "its texels are not width * height * 3");
    }
  }

  void require(bool holds, const char* kind, std::size_t number, const std::string& what) const {
    if (!holds) require(false, fmt::format("{} {}: {}", kind, number, what));
  }
  void require(bool holds, const std::string& what) const {
    if (holds) return;
    throw InputError(fmt::format("{}: {}", scene_.file.empty() ? "scene" : scene_.file, what));
  }

  const Scene& scene_;
};

}  // namespace

void validate(const Scene& scene) { Validation(scene).run(); }

Scene sceneOfTriangles(std::span<const Vec3> vertices,
                       std::span<const std::array<Index, 3>> triangles,
                       std::span<const Material> materials,
                       std::span<const Index> triangle_material) {
  if (!triangle_material.empty() && triangle_material.size() != triangles.size()) {
    throw InputError(fmt::format("scene: {} triangles have {} materials; give one each, or none",
                                 triangles.size(), triangle_material.size()));
  }
  Scene scene;
  scene.vertices.assign(vertices.begin(), vertices.end());
  scene.materials.assign(materials.begin(), materials.end());
  for (Index m = 0; m < scene.materials.size(); ++m) {
    const std::string& name = scene.materials[m].name;
    scene.surfaces.push_back({name, m, name.empty() ? fmt::format("material {}", m) : name});
  }
  scene.face_offset.reserve(triangles.size() + 1);
  scene.face_offset.push_back(0);
  scene.corners.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    scene.corners.insert(scene.corners.end(), triangles[t].begin(), triangles[t].end());
    scene.face_offset.push_back(scene.corners.size());
    scene.face_surface.push_back(triangle_material.empty() ? 0 : triangle_material[t]);
    scene.face_element.push_back(t);
  }
  validate(scene);
  return scene;
}

}  // namespace radiosity
