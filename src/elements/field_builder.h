// One field of elements, refined where interpolation is not accurate enough.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "elements/surface_points.h"
#include "radiosity/elements.h"

namespace radiosity {

/// The emitters and occluders of a whole element.
struct ElementLights {
  virtual ~ElementLights() = default;
  enum class Kind : std::uint8_t {
    dark,     ///< proved to get no light
    plain,    ///< no occluders
    partial,  ///< some occluders
    by_rays   ///< so many occluders that light is found by rays
  };
  Kind kind = Kind::plain;
  bool settled = false;  ///< the same holds for all parts of the element
};

/// The shape of an element.
struct ElementShape {
  Index root = 0;
  std::array<Vec3, 4> corners;  ///< metres; a triangle's fourth repeats its third
};

/// Computes irradiance at points. Calls come from several threads.
class FieldLight {
 public:
  virtual ~FieldLight() = default;
  /// `parent`: the lights of an element that holds this one; null: a root.
  virtual std::shared_ptr<const ElementLights> lightsOf(const ElementShape& shape,
                                                        const ElementLights* parent) const = 0;
  /// Irradiance at a point of the element that has these lights: one value a band. Returns the
  /// square of its standard error, summed over the bands; less than 0 if the point is behind a
  /// surface, as a vertex may be where bodies reach through each other.
  virtual double irradiance(const SurfacePoint& point, const ElementLights* lights,
                            std::span<double> out) const = 0;
};

/// What a root's light is for.
enum class RootUse : std::uint8_t {
  shown,   ///< itself
  source,  ///< light that others get of it
  none     ///< nothing: it is not evaluated
};

/// The rules by which elements are cut.
struct RefinementRule {
  double tolerance = 0.01;
  double smallest_edge = 0;  ///< metres
  /// Elements with edges down to a fraction of `smallest_edge` are cut if their corners differ by
  /// more than this share: where bodies reach through each other, some corners are hidden.
  double steep_spread = 1;
  double steep_fraction = 1;
  /// Metres. An element with partial light is cut down to this edge for any values: coarser ones
  /// miss whole shadows.
  double partial_edge = 0;
  /// An element whose corners differ by less than this share is not tested.
  double least_spread = 0;
  double reference_edge = 1;  ///< metres: the edge to which the tolerance applies
  double least_light = 0;     ///< W/m^2 over all bands: the least light that errors are compared to
  /// N: light of the other field, over all bands. Errors are compared to the sum of both fields.
  std::span<const double> other_light;
  /// N * bands: light of the patches, for points behind a surface.
  std::span<const double> patch_light;
  std::size_t most_vertices = 0;  ///< besides the corners of roots
  /// R; empty: all are shown. Sources are cut only down to `source_edge` (metres) and do not change
  /// the edges that they share with roots that are shown.
  std::span<const RootUse> use;
  double source_edge = 0;
  bool shown_alone = false;  ///< sources are not evaluated
  /// A root with longer edges is cut for any values.
  double longest_edge = 0;
  bool keep_lights = false;  ///< FieldSummary::lights are wanted
  /// A field of the same surface, all of it shown: elements are cut as they are there, whatever the
  /// other rules say; or null.
  const ElementField* like = nullptr;
};

/// A field and its figures.
struct FieldSummary {
  ElementField field;
  std::vector<std::shared_ptr<const ElementLights>> lights;  ///< of each leaf, or none
  std::size_t evaluated = 0;
  std::size_t unrefined = 0;
  double shortest_edge = 0;
  double interpolation_square = 0;  ///< integral over the area of the square of the error
  double noise_square = 0;          ///< likewise
  double light_square = 0;          ///< of irradiance, both fields
  double area = 0;
};

/// Cuts elements breadth first. The vertices of a round are numbered in order and evaluated in
/// parallel, so results do not depend on threads. At the end values are raised such that linear
/// interpolation has the means of light (mean_lift.h). On an edge that a coarser neighbour shares
/// they are set to the neighbour's, so the field is continuous. `stage`: the name of each round, a
/// stage of progress. Throws Cancelled.
FieldSummary buildField(const PatchMesh& mesh, const ElementSurface& surface,
                        const FieldLight& light, const RefinementRule& rule, int bands,
                        const std::string& stage, Progress& progress);

}  // namespace radiosity
