// Checks of a scene: notes on surfaces that look wrong, by name.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "base/geometry/box_tree.h"
#include "radiosity/scene.h"
#include "scene/overlaps.h"
#include "scene/topology.h"
#include "scene/winding_tree.h"

namespace radiosity {

/// Where something is with respect to a closed part.
enum class Place { inside, on, outside };

class SceneChecks {
 public:
  SceneChecks(const Scene& scene, const WeldedFaces& faces);

  /// Every edge is shared by two faces, oppositely, or one closed part encloses all others.
  bool closed() const;
  /// One closed part that faces inwards holds all others: no sky is seen.
  bool enclosed() const;
  std::size_t openEdges() const { return topology_.open_edges; }

  /// No emitter, emitters without area, a closed room that absorbs nothing.
  void reportLight(SceneInfo& info) const;
  /// A size that speaks for another unit, a place too far from the origin.
  void reportExtent(SceneInfo& info) const;
  /// Degenerate, doubled and non-planar faces.
  void reportFaces(SceneInfo& info) const;
  /// Faces wound against their neighbours, solids and rooms that are inside out.
  void reportOrientation(SceneInfo& info) const;
  /// Faces of different surfaces in one plane.
  void reportOverlaps(SceneInfo& info) const;

 private:
  const Material& materialOf(Index face) const { return scene_.materialOf(face); }
  const std::string& surfaceOf(Index face) const {
    return scene_.surfaces[scene_.face_surface[face]].name;
  }
  bool emits(Index face) const { return materialOf(face).emission != Vec3(0.0); }
  /// The surfaces a part has faces of, each once.
  std::vector<std::string> surfacesOf(const ConnectedPart& part) const;
  /// "a/b, c/d" of them.
  std::string namesOf(const ConnectedPart& part) const;
  Place placeOf(const Vec3& point, const ConnectedPart& outer) const;
  Place placeOf(const ConnectedPart& inner, const ConnectedPart& outer) const;
  /// Parts whose boxes meet that of `part`, ascending.
  std::vector<std::size_t> partsNear(const ConnectedPart& part) const;
  /// Closed parts turned inward within a solid: they make it hollow.
  std::vector<const ConnectedPart*> cavitiesOf(const ConnectedPart& solid) const;
  /// Whether a part that is turned inward lies within a solid.
  bool isCavity(const ConnectedPart& part) const;
  /// Surfaces of parts that lie within `outer` and not in one of its `cavities`, each once, in the
  /// order of the parts; no more are looked for once there are `most`.
  std::vector<std::string> contentsOf(const ConnectedPart& outer,
                                      std::span<const ConnectedPart* const> cavities,
                                      std::size_t most) const;
  void reportFlippedFaces(SceneInfo& info) const;
  void reportInsideOut(SceneInfo& info) const;
  void reportPart(const ConnectedPart& part, SceneInfo& info) const;

  const Scene& scene_;
  const WeldedFaces& faces_;
  std::vector<DoubledFace> doubled_;
  std::vector<std::uint8_t> is_double_;  ///< F
  Topology topology_;
  BoxTree part_boxes_;                                           ///< by part
  mutable std::map<const ConnectedPart*, WindingTree> winding_;  ///< of the parts asked about
};

}  // namespace radiosity
