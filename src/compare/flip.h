// FLIP: how different two pictures look that are shown in turn at the same place.
#pragma once

#include <vector>

#include "compare/gaussian.h"
#include "radiosity/base.h"

namespace radiosity {

/// Linear Rec. 709 a pixel, row-major.
struct ColourPlane {
  int width = 0;
  int height = 0;
  std::vector<Vec3> pixels;
};

/// P. Andersson, J. Nilsson, T. Akenine-Moeller, M. Oskarsson, K. Astrom & M. Fairchild, "FLIP: a
/// difference evaluator for alternating images", Proc. ACM CGIT 3(2), 2020, with its constants, for
/// a display of .7 m and 3,840 pixels seen from .7 m. Values are clamped to [0, 1], which is what a
/// display shows. A value a pixel, 0 (the same) to 1.
Plane flipOfShown(const ColourPlane& a, const ColourPlane& b);

/// P. Andersson, J. Nilsson, P. Shirley & T. Akenine-Moeller, "Visualizing errors in rendered high
/// dynamic range images", Eurographics Short Papers 2021: of pictures that hold light, the largest
/// FLIP over the exposures at which the reference `a` is neither all dark nor all white, by the
/// ACES curve of K. Narkowicz.
Plane flipOfLight(const ColourPlane& a, const ColourPlane& b);

}  // namespace radiosity
