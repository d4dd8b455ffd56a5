// SSIM: how alike the structures of two pictures are.
#pragma once

#include <optional>

#include "compare/gaussian.h"

namespace radiosity {

/// Z. Wang, A. Bovik, H. Sheikh & E. Simoncelli, "Image quality assessment: from error visibility
/// to structural similarity", IEEE Trans. Image Processing 13(4), 2004: windows of 11 x 11 with a
/// Gaussian of 1.5 pixels, K1 = .01, K2 = .03, of values in [0, 1]. The mean over the windows that
/// lie within the picture, at most 1 (the same); none of a picture smaller than a window.
std::optional<double> structuralSimilarity(const Plane& a, const Plane& b);

}  // namespace radiosity
