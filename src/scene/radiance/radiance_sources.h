// Radiance's sources: suns and skies.
#pragma once

#include <vector>

#include "radiosity/scene.h"
#include "scene/radiance/radiance_materials.h"

namespace radiosity {

/// Collects the sources of a scene, solid angles far away, as lights.
class RadianceSources {
 public:
  RadianceSources(const RadianceReader& reader, FeatureNotes& notes)
      : reader_(reader), notes_(notes) {}

  /// A disc of up to 90 degrees is a sun, one of 180 half a sky and of 360 a whole one, each of one
  /// radiance. Others are left out, with a note. Errors: InputError for numbers that are none.
  void add(const RadiancePrimitive& source);
  /// Two halves of a sky, alike and opposite, are one sky.
  void appendTo(std::vector<Light>& lights) const;

 private:
  void addSun(const RadiancePrimitive& source, const Vec3& radiance);

  const RadianceReader& reader_;
  FeatureNotes& notes_;
  /// The sun alone is called by its kind's word, so that another may replace it.
  UniqueNames names_ = lightNames(Sun::kTraits.word);
  struct Half {
    std::string name;
    Vec3 middle{0.0};  ///< unit
    Vec3 radiance{0.0};
  };
  std::vector<Light> suns_;
  std::vector<Half> halves_;
  Vec3 whole_{0.0};  ///< W/m^2/sr, of whole skies
};

}  // namespace radiosity
