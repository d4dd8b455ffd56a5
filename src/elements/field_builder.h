// One field of elements, refined where interpolation fails.
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

/// What may light an element, known for all of it.
struct ElementLights {
  virtual ~ElementLights() = default;
  enum class Kind : std::uint8_t {
    dark,     ///< proved: nothing
    plain,    ///< nothing in between
    partial,  ///< something may be in between
    dear      ///< so much may be that light is found by rays
  };
  Kind kind = Kind::plain;
  bool settled = false;  ///< the same holds of all parts of the element
};

/// An element as it concerns light.
struct ElementShape {
  Index root = 0;
  std::array<Vec3, 4> corners;  ///< metres; a triangle's fourth repeats its third
};

/// Light that falls on points. Calls come from several threads.
class FieldLight {
 public:
  virtual ~FieldLight() = default;
  /// `parent`: of an element that holds this one; null: a root.
  virtual std::shared_ptr<const ElementLights> lightsOf(const ElementShape& shape,
                                                        const ElementLights* parent) const = 0;
  /// Irradiance at a point of the element of these lights, bands values. Returns the square of its
  /// standard error, summed over the bands; less than 0 where the point lies behind something, as
  /// a vertex may where bodies reach through each other.
  virtual double irradiance(const SurfacePoint& point, const ElementLights* lights,
                            std::span<double> out) const = 0;
};

/// When elements are cut.
struct RefinementRule {
  double tolerance = 0.01;
  double smallest_edge = 0;  ///< metres
  /// The same for dear light, which costs tens of times as much and is known less well.
  double dear_edge = 0;
  double dear_tolerance = 0.01;
  /// Elements with shorter edges, down to a fraction of that, are cut where their corners differ by
  /// more than this share: bodies that reach through each other hide some of them altogether.
  double steep_spread = 1;
  double steep_fraction = 1;
  /// Metres: an element with partial light is cut until its edges are no longer, whatever its
  /// values: coarser ones miss whole shadows.
  double partial_edge = 0;
  /// An element whose corners differ by less than this share is not tested.
  double least_spread = 0;
  double reference_edge = 1;  ///< metres: of which the tolerance is said
  double least_light = 0;     ///< W/m^2 over all bands: less counts as so much
  /// N: light of the other field, over all bands, to which errors are compared as well.
  std::span<const double> other_light;
  /// N * bands: light of the patches, which points behind something get.
  std::span<const double> patch_light;
  std::size_t most_vertices = 0;
  /// Facets of curved bodies, small already, are tested only where corners differ by this many
  /// times `least_spread`.
  double curved_spread = 1;
  /// R, 1: wanted in full; empty: all are. Others are cut only while longer than `unwanted_edge`
  /// (metres), and leave the edges they share with wanted ones alone; infinite: they are not
  /// evaluated.
  std::span<const std::uint8_t> wanted;
  double unwanted_edge = 0;
  /// A root with longer edges is cut whatever its values.
  double longest_edge = 0;
  bool keep_lights = false;  ///< FieldSummary::lights are wanted
};

/// What came of it.
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

/// Elements are cut breadth first: vertices of a round are numbered one after the other and
/// evaluated side by side, so that nothing depends on threads. Values in
/// the end are such that lines between them have light's means (mean_lift.h); on an edge that a
/// coarser neighbour shares they are set to the neighbour's: the field is continuous. `stage`: what
/// to call each round, a stage of progress. Throws Cancelled.
FieldSummary buildField(const PatchMesh& mesh, const ElementSurface& surface,
                        const FieldLight& light, const RefinementRule& rule, int bands,
                        const std::string& stage, Progress& progress);

}  // namespace radiosity
