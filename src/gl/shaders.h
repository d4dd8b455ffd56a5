// The steps of a hemicube on the device, in GLSL.
#pragma once

namespace radiosity::gl {

// Storage blocks are numbered as the comments list them; 64 or 128 invocations make a group.

/// What comes before each of the others that computes: types as in gpu_scene.h and gpu_eye.h, faces
/// as in face_geometry.h.
extern const char* const kTypes;

/// A candidate for every view and polygon: is it seen at all, from which side, and how its pixels
/// are found in its grid. Groups: polygons / 64, views. Blocks: vertices, corners, polygons, grids,
/// views, hidden bits, candidates, counts.
extern const char* const kFindCandidates;

/// Clips triangles to faces and projects them to pixels of the target. Groups: faces, views.
/// Blocks: vertices, triangles, views, candidates, corners drawn, the draw.
extern const char* const kClipTriangles;

/// Draws these triangles: polygon and depth of every pixel.
extern const char* const kDrawCorner;
extern const char* const kDrawPixel;

/// Finds the item of every pixel and adds up weights. Groups: pixels / 128, rows of all faces,
/// views. Blocks: candidates, grids, cells, nodes, running sums of the top face and of a side
/// face, low and high halves of the rows. Texture 0: polygons drawn.
extern const char* const kSumRows;

}  // namespace radiosity::gl
