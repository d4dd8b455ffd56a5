// What modifies a surface of a Radiance scene, as a material.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "radiosity/scene.h"
#include "scene/radiance/primitives.h"
#include "scene/scene_builder.h"

namespace radiosity {

/// What modifies a surface: the first material on the way from modifier to modifier. Modifiers on
/// all of the way count.
struct RadianceModifiers {
  const RadiancePrimitive* material = nullptr;  ///< or a mixture; null: there is none
  const RadiancePrimitive* pattern = nullptr;   ///< null: there is none
  const RadiancePrimitive* bump = nullptr;      ///< likewise

  bool emits() const;     ///< light, or a glow that lights anything
  Vec3 radiance() const;  ///< of one that emits, W/m^2/sr
};
RadianceModifiers modifiersOf(const RadianceReader& reader, const RadiancePrimitive& surface);

/// Makes the materials of a scene, those that surfaces have.
class RadianceMaterials {
 public:
  RadianceMaterials(const RadianceReader& reader, const SceneOptions& options, Scene& scene,
                    FeatureNotes& notes)
      : reader_(reader), options_(options), scene_(scene), notes_(notes) {}

  /// The material of a surface. kNone: the surface is none, and left out. Errors: InputError for a
  /// surface without one.
  Index of(const RadiancePrimitive& surface);

 private:
  Material make(const RadianceModifiers& modifiers);
  Material ofEmitter(const RadianceModifiers& modifiers, Material material);
  Material ofReflector(const RadiancePrimitive& given, Material material);

  const RadianceReader& reader_;
  const SceneOptions& options_;
  Scene& scene_;
  FeatureNotes& notes_;
  UniqueNames names_;
  /// By what is modified so: material and pattern.
  std::map<std::pair<const RadiancePrimitive*, const RadiancePrimitive*>, Index> made_;
};

}  // namespace radiosity
