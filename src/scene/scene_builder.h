// Parts shared by both readers: faces into surfaces, names that are unique, notes that name many at
// once.
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "radiosity/scene.h"

namespace radiosity {

/// Hands out names that differ: the second "lamp" becomes "lamp#2".
class UniqueNames {
 public:
  std::string make(const std::string& wanted);

 private:
  std::set<std::string> taken_;
  std::map<std::string, std::size_t> last_number_;  ///< by wanted name
};

/// Collects "this feature of that element is not used" and turns it into one note a feature.
class FeatureNotes {
 public:
  /// `shown`: so many names are written out, of the others how many they are.
  void add(const std::string& feature, const std::string& name, Severity severity = Severity::info,
           std::size_t shown = 12);
  /// Appends "FEATURE: NAME, NAME" for every feature, in the order they were first seen.
  void appendTo(std::vector<Note>& notes) const;

 private:
  struct Entry {
    std::string feature;
    Severity severity;
    std::size_t shown;
    std::vector<std::string> names;  ///< in the order they came, once each
    std::set<std::string> seen;
  };
  std::vector<Entry> entries_;
  std::map<std::string, std::size_t> entry_of_;  ///< by feature
};

/// Adds faces to a scene whose materials are there already.
class SceneBuilder {
 public:
  explicit SceneBuilder(Scene& scene);

  /// The surface of (object, material), made when first asked for.
  Index surface(const std::string& object, Index material);

  /// `texcoords`: one per corner, or empty where the face has none. InputError where there are more
  /// than 2^28 corners: instances of instances multiply, and nothing could be done with so many.
  void addFace(std::span<const Index> corners, std::span<const Vec2> texcoords, Index surface,
               std::size_t element);

  /// Names the surfaces. A textured surface with a face that has no texture coordinates falls
  /// back to its material's factor, with a warning.
  void finish();

 private:
  void dropUnusableTextures();

  Scene& scene_;
  std::map<std::pair<std::string, Index>, Index> surface_of_;
  std::vector<bool> lacks_texcoords_;  ///< by surface
};

inline bool isTextured(const Material& material) {
  return material.texture != kNone || material.emission_texture != kNone;
}

/// Material `name` with the default reflectance.
Material defaultMaterial(const std::string& name, const SceneOptions& options);

/// Throws InputError "WHERE: material NAME: ..." unless 0 <= rho <= 1 in every band.
void checkReflectance(const std::string& where, const std::string& name, const Vec3& reflectance);

/// Throws InputError "WHERE: material NAME: ..." unless `emission` is finite and >= 0.
void checkEmission(const std::string& where, const std::string& name, const Vec3& emission);

}  // namespace radiosity
