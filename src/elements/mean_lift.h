// Values at vertices such that lines between them have light's means.
#pragma once

#include <cstddef>
#include <span>

#include "elements/surface_points.h"
#include "radiosity/elements.h"

namespace radiosity {

/// Lines between points of what bends downwards lie below it: irradiance interpolated from its own
/// values is low, by .1% to .2% of all light in rooms. Here each vertex that is surrounded by cells
/// (leaves, or the parts of tested ones) is raised by what they lack in the mean. For squares of
/// side h that is h^2/12 times the Laplacian, which the sum of second differences at the vertex
/// tells: half of it, over 12. For equilateral triangles it is h^2/16 times the Laplacian, a third
/// of that sum, over 16. Bends are averaged over neighbours, so that noise of the values is not
/// raised, too. Vertices stay where neighbours do not balance, since a slope would count as a bend,
/// and where light bends by more than a hundredth of itself, as at the edges of shadows.
///
/// `points`: V, of the field's vertices; `light`: V, over all bands, W/m^2. Tested by
/// Elements.EnergyIsThatOfThePatches.
void liftToMeans(ElementField& field, std::span<const SurfacePoint> points,
                 std::span<const double> light, std::size_t bands);

}  // namespace radiosity
