// The steps of a hemicube on the device, in GLSL.
#pragma once

namespace radiosity::gl {

// Storage blocks are numbered as the comments list them; 64 or 128 invocations make a group.

/// The start of all compute shaders: types as in gpu_scene.h and gpu_eye.h, faces as in
/// face_geometry.h.
extern const char* const kTypes;

/// Makes a candidate for every view and polygon: whether and from which side it is seen, and the
/// functions that map pixels to its grid. Groups: polygons / 64, views. Blocks: vertices, corners,
/// polygons, grids, views, hidden bits, candidates, counts.
extern const char* const kFindCandidates;

/// Clips triangles to faces and projects them to pixels of the target. Groups: faces, views.
/// Blocks: vertices, triangles, views, candidates, corners drawn, the draw.
extern const char* const kClipTriangles;

/// Draws these triangles: polygon and depth of every pixel. The second comes after kTypes. Blocks:
/// candidates.
extern const char* const kDrawCorner;
extern const char* const kDrawPixel;

/// Follows kTypes in steps that work pixel by pixel. Groups: pixels / 128, rows of all faces,
/// views. Image 0: polygons drawn.
extern const char* const kPixels;

/// Finds the item of every pixel and adds up weights. If items are kept, they replace polygons in
/// the image. Blocks: candidates, grids, cells, nodes, running sums of the top face and of a side
/// face, low and high halves of the rows.
extern const char* const kSumRows;

/// Means of sources (GpuField). Groups: means * bands / 64. Blocks: sources, the first source of
/// each mean, radiosity. Does not need kTypes.
extern const char* const kMeans;

/// Weight times interpolated radiosity, summed over 128 pixels of a row; the image must hold items
/// (kSumRows). Blocks: running sums of the top face and of a side face, views, vertices, the first
/// facet of each patch, facets, radiosity, sums.
extern const char* const kInterpolate;

/// Irradiance of views, from these sums or from rows, and the next radiosity of their sources.
/// Groups: views. Blocks: low and high halves of the rows, views, radiosity, sums, materials
/// (emission, reflectance, the sky's irradiance), irradiance, next radiosity.
extern const char* const kGather;

}  // namespace radiosity::gl
