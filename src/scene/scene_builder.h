// Helpers of all readers: they sort faces into surfaces, make names unique, and join notes.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "radiosity/scene.h"

namespace radiosity {

/// Makes names unique: the second "lamp" becomes "lamp#2".
class UniqueNames {
 public:
  std::string make(const std::string& wanted);

 private:
  std::set<std::string> taken_;
  std::map<std::string, std::size_t> last_number_;  ///< by wanted name
};

/// Of lights: the words of their kinds, which options take for a kind, are taken; but for `free`.
UniqueNames lightNames(std::string_view free = {});

/// Collects features that are not used and makes one note for each feature.
class FeatureNotes {
 public:
  /// `shown`: the most names that are written out; the others are counted.
  void add(const std::string& feature, const std::string& name, Severity severity = Severity::info,
           std::size_t shown = 12);
  /// Appends "FEATURE: NAME, NAME" for every feature, in the order they were first seen.
  void appendTo(std::vector<Note>& notes) const;

 private:
  struct Entry {
    std::string feature;
    Severity severity;
    std::size_t shown;
    std::vector<std::string> names;  ///< in order, once each
    std::set<std::string> seen;
  };
  std::vector<Entry> entries_;
  std::map<std::string, std::size_t> entry_of_;  ///< by feature
};

/// Adds faces to a scene that already has its materials.
class SceneBuilder {
 public:
  SceneBuilder(Scene& scene, const SceneOptions& options);

  /// The surface of (object, material), made when first asked for.
  Index surface(const std::string& object, Index material);

  /// `texcoords`, `colours`: one for each corner, or empty. Errors: InputError if there are more
  /// than 2^28 corners: nested instances multiply, and such a scene could not be handled.
  void addFace(std::span<const Index> corners, std::span<const Vec2> texcoords, Index surface,
               std::size_t element, std::span<const Vec3> colours = {});

  /// Names the surfaces. A textured surface with a face that has no texture coordinates falls
  /// back to its material's factor, or to the default reflectance if that is 1, with a warning.
  void finish();

 private:
  void dropUnusableTextures();
  void nameSurfaces();

  Scene& scene_;
  const SceneOptions& options_;
  std::map<std::pair<std::string, Index>, Index> surface_of_;
  std::vector<bool> lacks_texcoords_;  ///< by surface
};

inline bool isTextured(const Material& material) {
  return material.texture != kNone || material.emission_texture != kNone;
}

/// The feature (FeatureNotes) of materials that light goes through, wholly or in part.
std::string solidFeature();
/// Of those with holes, which an image cuts out.
std::string maskFeature();

/// The name of the material of faces without one.
inline constexpr const char* kNoMaterial = "default";

/// A material `name` with the default reflectance.
Material defaultMaterial(const std::string& name, const SceneOptions& options);

/// The factor of the reflectance that a vertex's colour stands for. Empty if a number of it is
/// outside 0 to 1, so that it stands for none.
std::optional<Vec3> factorOfColour(const Vec3& colour, VertexColours meaning);

/// The note that objects called `names` have no material. `coloured`: their vertices have colours.
Note noMaterialNote(const std::vector<std::string>& names, bool coloured,
                    const SceneOptions& options);

/// Gives `material`, called `name`, the default reflectance in place of its `factor` ("Kd"), with a
/// note. For a factor that only stands beside a texture, and the texture is not used: 1, which
/// leaves the texture as it is and alone would return all light, or a 0 that was not meant.
void replaceStandIn(Material& material, const std::string& name, const char* factor,
                    const SceneOptions& options, FeatureNotes& notes);

/// A reflectance as it counts: what float rounding put above 1, by at most 1e-6, is 1, with a note.
Vec3 settledReflectance(const Vec3& reflectance, const std::string& material, FeatureNotes& notes);

// Readers keep what is out of range if options may mend it: requireMaterials() comes after these.

/// Whether options may replace or leave out what a file has.
bool mayMend(const SceneOptions& options);

bool isReflectance(const Vec3& reflectance);
bool isEmission(const Vec3& emission);

/// Throws InputError "WHERE: material NAME: ...", with the cure, unless isReflectance() and
/// isEmission().
void requireMaterial(const std::string& where, const Material& material);

/// The same for every material of a face. Others get the default reflectance and no emission, with
/// a note.
void requireMaterials(Scene& scene, const SceneOptions& options);

/// Throws InputError "WHERE: material NAME: ..." unless 0 <= rho <= 1 in every band.
void checkReflectance(const std::string& where, const std::string& name, const Vec3& reflectance);

/// Throws InputError "WHERE: material NAME: ..." unless `emission` is finite and >= 0.
void checkEmission(const std::string& where, const std::string& name, const Vec3& emission);

}  // namespace radiosity
