// Raises values at vertices such that linear interpolation has the means of light.
#pragma once

#include <cstddef>
#include <span>

#include "elements/surface_points.h"
#include "radiosity/elements.h"

namespace radiosity {

/// Chords of a concave function lie below it: irradiance interpolated between exact values is low,
/// by .1% to .2% of all light in rooms. Each vertex that is surrounded by cells (leaves, or the
/// parts of tested ones) is raised by the mean shortfall of its cells. For squares of side h this
/// is h^2/12 times the Laplacian: half of the sum of second differences at the vertex, over 12. For
/// equilateral triangles it is h^2/16 times the Laplacian: a third of that sum, over 16. Bends are
/// averaged over neighbours, so that noise is not amplified. A vertex is not raised if its
/// neighbours are not balanced, since a slope would count as a bend, or if light bends by more than
/// a hundredth of itself, as at the edges of shadows.
///
/// `points`: V, of the field's vertices; `light`: V, over all bands, W/m^2. Tested by
/// Elements.EnergyIsThatOfThePatches.
void liftToMeans(ElementField& field, std::span<const SurfacePoint> points,
                 std::span<const double> light, std::size_t bands);

}  // namespace radiosity
