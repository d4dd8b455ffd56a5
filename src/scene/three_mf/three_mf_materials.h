// Materials of a 3MF file: groups of base materials (core specification, chapter 5) and of colours
// (3MF Consortium, "Materials and Properties Extension Specification", chapter 3).
#pragma once

#include <map>
#include <string>
#include <tuple>

#include "radiosity/scene.h"
#include "scene/scene_builder.h"
#include "scene/three_mf/three_mf_package.h"

namespace radiosity {

class ThreeMfMaterials {
 public:
  ThreeMfMaterials(const ThreeMfPackage& package, const SceneOptions& options, Scene& scene,
                   FeatureNotes& notes)
      : package_(package), options_(options), scene_(scene), notes_(notes) {}

  /// The material of `object` that is member `member` (counted from 0) of group `group` in `model`;
  /// kNone, with a note, for a kind of group that is not read. Errors: InputError if there is no
  /// such group or member, or if its colour is invalid.
  Index of(const ThreeMfModel& model, const std::string& group, const std::string& member,
           const std::string& object);
  /// The material of an object without one in the file: its own, with the default reflectance.
  Index ownOf(const std::string& object);

 private:
  Index read(const ThreeMfModel& model, const std::string& group, const std::string& member,
             const std::string& object);
  Index added(const std::string& name, const std::string& colour);
  Vec3 reflectanceOf(const std::string& name, const std::string& colour) const;

  const ThreeMfPackage& package_;
  const SceneOptions& options_;
  Scene& scene_;
  FeatureNotes& notes_;
  UniqueNames names_;
  std::map<std::tuple<const ThreeMfModel*, std::string, std::string>, Index> known_;
  std::map<std::pair<std::string, std::string>, Index> added_;  ///< by name and colour
  std::map<std::string, Index> own_;                            ///< by object
};

}  // namespace radiosity
