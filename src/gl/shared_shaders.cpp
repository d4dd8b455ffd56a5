// The parts that several shaders share.
#include "gl/shaders.h"

namespace radiosity::gl {

const char* const kTypes = R"(#version 430 core
const uint kNone = 0xffffffffu;
struct Polygon {
  double normal[3], origin[3];
  uint corner_begin, corner_end;
  int item[2], grid[2];
};
struct Grid {
  double u_axis[3], v_axis[3], u_offset, v_offset;
  int columns, rows, first_cell, first_node;
};
struct Node {
  float a, b, c;
  int inside, outside;
};
struct View {
  double eye[3], axes[9];
  uint own, source;
};
// In the eye's frame, along a pixel's ray r: 1 / depth = dot(plane, r), column = dot(u, r) * depth,
// row = dot(v, r) * depth.
struct Candidate {
  vec4 plane, u, v;
  int item, grid;
  uint signs;  // of its corners, as signCode(); 0: not seen
  uint padding;
};
// A point or direction as a face sees it: x, y and the distance along the face's axis.
#define PROJECT(Vec)                          \
  Vec project(uint face, Vec p) {             \
    switch (face) {                           \
      case 0u: return p;                      \
      case 1u: return Vec(p.y, p.z, p.x);     \
      case 2u: return Vec(-p.x, p.z, p.y);    \
      case 3u: return Vec(-p.y, p.z, -p.x);   \
      default: return Vec(p.x, p.z, -p.y);    \
    }                                         \
  }
PROJECT(vec3)
PROJECT(dvec3)
// Through the centre of a pixel of a face, as that sees it.
vec3 rayThrough(ivec2 at, uint face, int resolution) {
  vec2 centre = vec2(at.x + 0.5 * (1 - resolution),
                     at.y + 0.5 * (face == 0u ? 1 - resolution : 1));
  return vec3(centre * (2.0 / resolution), 1);
}
dvec3 vec(double v[3]) { return dvec3(v[0], v[1], v[2]); }
dvec3 toEye(View view, dvec3 direction) {
  return dvec3(dot(direction, dvec3(view.axes[0], view.axes[1], view.axes[2])),
               dot(direction, dvec3(view.axes[3], view.axes[4], view.axes[5])),
               dot(direction, dvec3(view.axes[6], view.axes[7], view.axes[8])));
}
// FaceGeometry::mayCover(): a corner lies strictly inside each of the face's planes.
const uint kInside[5] = uint[5](0x0f00u, 0x7002u, 0x5028u, 0x4031u, 0x6014u);
bool mayCover(uint face, uint signs) { return (signs & kInside[face]) == kInside[face]; }
)";

const char* const kPixels = R"(
layout(local_size_x = 128) in;
layout(r32ui, binding = 0) uniform uimage2D picture;
uniform int resolution;
uniform int tiles_across;

// A pixel of a face: groups go along rows of all faces, the top face's first.
struct Pixel {
  uint face;
  int x, y;     // on the face
  ivec2 place;  // in the picture, as kClipTriangles places it
  vec3 ray;     // through its centre, as the face sees it
};
Pixel thisPixel() {
  int half_face = resolution / 2;
  int row = int(gl_WorkGroupID.y);
  Pixel pixel;
  pixel.face = row < resolution ? 0u : 1u + uint((row - resolution) / half_face);
  pixel.x = int(gl_GlobalInvocationID.x);
  pixel.y = pixel.face == 0u ? row : (row - resolution) % half_face;
  ivec2 corner = ivec2(pixel.face == 0u || pixel.face == 3u ? 0 : resolution,
                       pixel.face < 2u ? 0 : pixel.face == 2u ? half_face : resolution);
  uint tile = gl_WorkGroupID.z;
  corner += ivec2(tile % uint(tiles_across), tile / uint(tiles_across)) *
            ivec2(2 * resolution, 3 * half_face);
  pixel.place = corner + ivec2(pixel.x, pixel.y);
  pixel.ray = rayThrough(ivec2(pixel.x, pixel.y), pixel.face, resolution);
  return pixel;
}
// Of the running sums of its row, which of its face's.
int sumAt(Pixel pixel) {
  int row = pixel.face == 0u ? min(pixel.y, resolution - 1 - pixel.y) : pixel.y;
  return row * (resolution + 1) + pixel.x;
}
)";

}  // namespace radiosity::gl
