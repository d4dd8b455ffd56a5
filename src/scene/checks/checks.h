// Checks a scene and notes surfaces that look wrong, by name.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/geometry/box_tree.h"
#include "base/geometry/containment.h"
#include "radiosity/scene.h"
#include "scene/checks/overlaps.h"
#include "scene/checks/topology.h"
#include "scene/checks/winding_tree.h"

namespace radiosity {

/// Names materials that return all light, by reflectance alone; none: nothing.
std::optional<Note> whiteMaterials(const Scene& scene);

/// Why the mesh has nothing of the `dropped` surfaces, which see nothing: a text each, with the
/// cure. `weld`: coincidence, as a fraction of the scene's diagonal.
std::vector<std::string> whyDropped(const Scene& scene, double weld,
                                    std::span<const Index> dropped);

class SceneChecks {
 public:
  SceneChecks(const Scene& scene, const WeldedFaces& faces);

  /// Whether every edge is shared by two faces in opposite directions, or one closed part encloses
  /// all others.
  bool closed() const;
  /// Whether a closed part that faces inwards holds all others, so that no face sees the sky.
  bool enclosed() const;
  std::size_t openEdges() const { return topology_.open_edges; }

  /// Notes that there is no emitter, emitters without area, and a closed room that absorbs nothing.
  void reportLight(SceneInfo& info) const;
  /// Notes a size that suggests another unit, and a place too far from the origin.
  void reportExtent(SceneInfo& info) const;
  /// Notes degenerate, doubled and non-planar faces.
  void reportFaces(SceneInfo& info) const;
  /// Notes faces wound against their neighbours, and solids and rooms that are inside out.
  void reportOrientation(SceneInfo& info) const;
  /// Notes overlapping faces of different surfaces in one plane.
  void reportOverlaps(SceneInfo& info) const;

  /// S, 1: most of its area is wound against the part that it belongs to.
  std::vector<std::uint8_t> turnedSurfaces() const;
  /// The surfaces of the smallest solid in or on which a surface begins: a closed part that is
  /// one-sided and turned outward. Empty: there is none.
  std::vector<std::string> solidAround(Index surface) const;

 private:
  const Material& materialOf(Index face) const { return scene_.materialOf(face); }
  const std::string& surfaceOf(Index face) const {
    return scene_.surfaces[scene_.face_surface[face]].name;
  }
  bool emits(Index face) const { return materialOf(face).emission != Vec3(0.0); }
  /// The surfaces of a part's faces, in the order of the scene.
  std::vector<std::string> surfacesOf(const ConnectedPart& part) const;
  /// Their names: "a/b, c/d".
  std::string namesOf(const ConnectedPart& part) const;
  Vec3 middleOf(std::size_t face) const;
  Containment placeOf(const Vec3& point, const ConnectedPart& outer) const;
  Containment placeOf(const ConnectedPart& inner, const ConnectedPart& outer) const;
  /// The parts whose boxes meet that of `part`, ascending.
  std::vector<std::size_t> partsNear(const ConnectedPart& part) const;
  /// The closed parts turned inward within a solid, which make it hollow.
  std::vector<const ConnectedPart*> cavitiesOf(const ConnectedPart& solid) const;
  /// Whether a part that is turned inward lies within a solid.
  bool isCavity(const ConnectedPart& part) const;
  /// The surfaces of parts within `outer` but not in one of its `cavities`, each once, in the order
  /// of the parts. The search stops once there are `most`.
  std::vector<std::string> contentsOf(const ConnectedPart& outer,
                                      std::span<const ConnectedPart* const> cavities,
                                      std::size_t most) const;
  void reportFlippedFaces(SceneInfo& info) const;
  void reportInsideOut(SceneInfo& info) const;
  void reportPart(const ConnectedPart& part, SceneInfo& info) const;
  void reportLoneShell(SceneInfo& info) const;
  bool isOneSided(const ConnectedPart& part) const;

  const Scene& scene_;
  const WeldedFaces& faces_;
  std::vector<DoubledFace> doubled_;
  std::vector<std::uint8_t> is_double_;  ///< F
  Topology topology_;
  BoxTree part_boxes_;                                           ///< by part
  mutable std::map<const ConnectedPart*, WindingTree> winding_;  ///< of the parts tested so far
};

}  // namespace radiosity
