// Light along random paths from the eye (Kajiya, "The Rendering Equation", 1986).
#pragma once

#include "path_tracer/scrambled_points.h"
#include "path_tracer/traced_scene.h"

namespace radiosity::bench {

struct PathOptions {
  /// Reflections; 1: direct light alone. 0: no end but that of chance.
  int most_bounces = 0;
  /// The first surface has the normals between its corners', as interpolation over facets shows it.
  bool smooth = true;
};

struct PathLight {
  Vec3 radiance{0.0};  ///< W/m^2/sr
  bool emits = false;  ///< the eye sees something that shines
  bool misses = false;
};

/// One path. At each surface a point of what shines is looked at, and the next direction is spread
/// by the cosine; where both may bring the same light they are weighed by the balance heuristic
/// (Veach & Guibas 1995). From the fifth bounce on paths go on by chance. An unbiased estimate of
/// the radiance.
PathLight tracePath(const TracedScene& scene, const Vec3& eye, const Vec3& direction,
                    const PathOptions& options, ScrambledPoints& points);

}  // namespace radiosity::bench
