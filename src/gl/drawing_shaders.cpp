// The shaders that clip and draw polygons: candidates, triangles, pixels.
#include "gl/shaders.h"

namespace radiosity::gl {

const char* const kFindCandidates = R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Vertices { double vertices[]; };
layout(std430, binding = 1) readonly buffer Corners { uint corners[]; };
layout(std430, binding = 2) readonly buffer Polygons { Polygon polygons[]; };
layout(std430, binding = 3) readonly buffer Grids { Grid grids[]; };
layout(std430, binding = 4) readonly buffer Views { View views[]; };
layout(std430, binding = 5) readonly buffer Hidden { uint hidden[]; };
layout(std430, binding = 6) writeonly buffer Candidates { Candidate candidates[]; };
layout(std430, binding = 7) buffer Counts { uint own_plane, horizon, facing_away, face, rasterised; };
uniform uint polygon_count;
uniform uint hidden_words;  // a view
uniform double coincidence;
const double kEdgeOn = 1e-30LF;  // as in hemicube_drawing.cpp
const uint kOffPlane = 1u << 15, kAboveHorizon = 1u << 14;

uint signsOf(dvec3 p) {
  double values[7] = double[7](p.z + p.x, p.z - p.x, p.z + p.y, p.z - p.y, p.x + p.y, p.x - p.y, p.z);
  uint signs = abs(p.z) > coincidence ? kOffPlane : 0u;
  for (int k = 0; k < 7; ++k) signs |= uint(values[k] < 0) << k | uint(values[k] > 0) << (k + 8);
  return signs;
}

// Signs of the corners, or 0 for what is not seen, which is counted.
uint look(uint p, Polygon polygon, View view, double distance) {
  uint signs = 0u;
  for (uint c = polygon.corner_begin; c < polygon.corner_end; ++c) {
    uint at = 3u * corners[c];
    dvec3 vertex = dvec3(vertices[at], vertices[at + 1u], vertices[at + 2u]);
    signs |= signsOf(toEye(view, vertex - vec(view.eye)));
  }
  if (p == view.own || (signs & kOffPlane) == 0u || !(abs(distance) > kEdgeOn)) {
    atomicAdd(own_plane, 1u);
    return 0u;
  }
  if ((signs & kAboveHorizon) == 0u) {
    atomicAdd(horizon, 1u);
    return 0u;
  }
  uint word = hidden[gl_WorkGroupID.y * hidden_words + p / 32u];
  if (distance > 0 && (word >> (p % 32u) & 1u) != 0u) {
    atomicAdd(facing_away, 1u);
    return 0u;
  }
  uint faces = 0u;
  for (uint f = 0u; f < 5u; ++f) faces += uint(mayCover(f, signs));
  atomicAdd(rasterised, faces);
  atomicAdd(face, 5u - faces);
  return signs;
}

void main() {
  uint p = gl_GlobalInvocationID.x;
  if (p >= polygon_count) return;
  View view = views[gl_WorkGroupID.y];
  Polygon polygon = polygons[p];
  dvec3 eye = vec(view.eye) - vec(polygon.origin);
  double distance = -dot(vec(polygon.normal), eye);
  Candidate seen;
  seen.signs = look(p, polygon, view, distance);
  int side = distance > 0 ? 1 : 0;
  seen.item = polygon.item[side];
  seen.grid = polygon.grid[side];
  dvec3 plane = toEye(view, vec(polygon.normal)) / distance;
  seen.plane = vec4(plane, 0);
  if (seen.signs != 0u && seen.grid >= 0) {
    Grid grid = grids[seen.grid];
    double u = dot(vec(grid.u_axis), eye) + grid.u_offset;
    double v = dot(vec(grid.v_axis), eye) + grid.v_offset;
    seen.u = vec4(toEye(view, vec(grid.u_axis)) + u * plane, 0);
    seen.v = vec4(toEye(view, vec(grid.v_axis)) + v * plane, 0);
  }
  candidates[gl_WorkGroupID.y * polygon_count + p] = seen;
}
)";

const char* const kClipTriangles = R"(
layout(local_size_x = 64) in;
struct Corner {
  float x, y;
  float farthest, nearest;  // 1 / distance, of the corners of what is drawn
  uint polygon;
};
layout(std430, binding = 0) readonly buffer Vertices { double vertices[]; };
layout(std430, binding = 1) readonly buffer Triangles { uvec4 triangles[]; };
layout(std430, binding = 2) readonly buffer Views { View views[]; };
layout(std430, binding = 3) readonly buffer Candidates { Candidate candidates[]; };
layout(std430, binding = 4) writeonly buffer Drawn { Corner drawn[]; };
// As glDrawArraysIndirect() reads it, then the corners that there would have been room needed for.
layout(std430, binding = 5) buffer Draw { uint count, instances, first, base_instance, needed; };
uniform uint triangle_count;
uniform uint polygon_count;
uniform uint capacity;  // of `drawn`
uniform int resolution;
uniform int tiles_across;
const int kMostCorners = 7;

shared uint before[64];
shared uint base;

// Positive inside; planes as SidePlane counts them.
double side(uint face, dvec3 p, int plane) {
  switch (plane) {
    case 0: return p.z + p.x;
    case 1: return p.z - p.x;
    case 2: return face == 0u ? p.z + p.y : p.y;
    default: return p.z - p.y;
  }
}

bool precedes(dvec3 a, dvec3 b) {
  if (a.x != b.x) return a.x < b.x;
  return a.y != b.y ? a.y < b.y : a.z < b.z;
}

// From its ends in a fixed order: neighbours get the same point to the bit.
dvec3 crossing(dvec3 a, dvec3 b, double side_a, double side_b) {
  if (precedes(b, a)) return b + side_b / (side_b - side_a) * (a - b);
  return a + side_a / (side_a - side_b) * (b - a);
}

// Clips a loop of `count` corners and returns how many are left.
int clip(inout dvec3 loop[kMostCorners], int count, uint face) {
  for (int plane = 0; plane < 4 && count > 0; ++plane) {
    dvec3 kept[kMostCorners];
    int left = 0;
    dvec3 last = loop[count - 1];
    double from = side(face, last, plane);
    for (int k = 0; k < count; ++k) {
      double to = side(face, loop[k], plane);
      if ((from < 0) != (to < 0) && left < kMostCorners) kept[left++] = crossing(last, loop[k], from, to);
      if (!(to < 0) && left < kMostCorners) kept[left++] = loop[k];
      last = loop[k];
      from = to;
    }
    loop = kept;
    count = left;
  }
  return count;
}

int clipped(uint t, View view, uint face, out dvec3 loop[kMostCorners]) {
  uvec4 triangle = triangles[t];
  uint signs = candidates[gl_WorkGroupID.y * polygon_count + triangle.w].signs;
  if (!mayCover(face, signs)) return 0;
  for (int k = 0; k < 3; ++k) {
    uint at = 3u * triangle[k];
    dvec3 vertex = dvec3(vertices[at], vertices[at + 1u], vertices[at + 2u]);
    loop[k] = project(face, toEye(view, vertex - vec(view.eye)));
  }
  int count = clip(loop, 3, face);
  // Only the eye itself has no distance inside a face: the polygon is seen edge-on.
  for (int k = 0; k < count; ++k) if (!(loop[k].z > 0)) return 0;
  return count;
}

Corner place(dvec3 p, uint face, vec2 range, uint polygon) {
  double half_face = 0.5LF * resolution;
  dvec2 middle = dvec2(half_face, face == 0u ? half_face : 0.0LF);
  // The top face, then two side faces to its right, and two above.
  ivec2 corner = ivec2(face == 0u || face == 3u ? 0 : resolution,
                       face < 2u ? 0 : face == 2u ? resolution / 2 : resolution);
  uint tile = gl_WorkGroupID.y;
  corner += ivec2(tile % uint(tiles_across), tile / uint(tiles_across)) *
            ivec2(2 * resolution, 3 * resolution / 2);
  // Whole numbers of 1/256 of a pixel. Up to 2^16 pixels they are floats, and so is all that comes
  // of them until the rasteriser has them: a hemicube looks the same in every tile.
  dvec2 on_face = roundEven(256.0LF * half_face * p.xy / p.z) * 0.00390625LF;
  dvec2 pixel = dvec2(corner) + middle + on_face;
  return Corner(float(pixel.x), float(pixel.y), range.x, range.y, polygon);
}

// Groups set room aside one piece of their triangles after the other, so that those of one face are
// drawn in their order: of equal depths the first stays.
void main() {
  uint face = gl_WorkGroupID.x;
  uint lane = gl_LocalInvocationID.x;
  View view = views[gl_WorkGroupID.y];
  for (uint first_triangle = 0u; first_triangle < triangle_count; first_triangle += 64u) {
    dvec3 loop[kMostCorners];
    uint t = first_triangle + lane;
    int corners = t < triangle_count ? clipped(t, view, face, loop) : 0;
    uint mine = corners < 3 ? 0u : 3u * uint(corners - 2);
    before[lane] = mine;
    barrier();
    for (uint step = 1u; step < 64u; step *= 2u) {
      uint sum = before[lane] + (lane >= step ? before[lane - step] : 0u);
      barrier();
      before[lane] = sum;
      barrier();
    }
    if (lane == 63u && before[63] > 0u) {
      base = atomicAdd(needed, before[63]);
      if (base + before[63] <= capacity) atomicMax(count, base + before[63]);
    }
    barrier();
    uint at = base + before[lane] - mine;
    if (mine > 0u && base + before[63] <= capacity) {
      double least = loop[0].z;
      double most = loop[0].z;
      for (int k = 1; k < corners; ++k) {
        least = min(least, loop[k].z);
        most = max(most, loop[k].z);
      }
      vec2 range = vec2(1 / most, 1 / least);
      for (int k = 1; k + 1 < corners; ++k) {
        drawn[at++] = place(loop[0], face, range, triangles[t].w);
        drawn[at++] = place(loop[k], face, range, triangles[t].w);
        drawn[at++] = place(loop[k + 1], face, range, triangles[t].w);
      }
    }
    barrier();
  }
}
)";

const char* const kDrawCorner = R"(#version 430 core
layout(location = 0) in vec4 corner;  // pixels of the target; 1 / distance of what is drawn
layout(location = 1) in uint polygon;
uniform vec2 scale;  // 2 / the viewport's size, a power of two
flat out uint drawn;
flat out vec2 range;
void main() {
  drawn = polygon;
  range = corner.zw;
  gl_Position = vec4(scale * corner.xy - 1, 0, 1);
}
)";

// Depths are inverse distances of the plane at the pixel's centre. Depths that the rasteriser
// interpolates between corners would depend on their place in the target. A centre may lie 1/256 of
// a pixel outside the polygon. There the plane of a polygon seen edge-on may be at any distance, so
// we limit it to the distances of the corners.
const char* const kDrawPixel = R"(
layout(std430, binding = 0) readonly buffer Candidates { Candidate candidates[]; };
uniform uint polygon_count;
uniform int resolution;
uniform int tiles_across;
flat in uint drawn;
flat in vec2 range;
layout(location = 0) out uint polygon;
const float kNearest = 5.9604644775390625e-8;  // 2^-24: what is nearer is not told apart

void main() {
  int half_face = resolution / 2;
  ivec2 size = ivec2(2 * resolution, 3 * half_face);
  ivec2 tile = ivec2(gl_FragCoord.xy) / size;
  ivec2 place = ivec2(gl_FragCoord.xy) - tile * size;
  // As kClipTriangles places the faces.
  bool right = place.x >= resolution;
  bool above = place.y >= resolution;
  uint face = above ? (right ? 4u : 3u) : !right ? 0u : place.y < half_face ? 1u : 2u;
  ivec2 at = ivec2(right ? place.x - resolution : place.x, face == 0u ? place.y : place.y % half_face);
  uint view = uint(tile.y * tiles_across + tile.x);
  vec3 plane = project(face, candidates[view * polygon_count + drawn].plane.xyz);
  gl_FragDepth = kNearest * clamp(dot(plane, rayThrough(at, face, resolution)), range.x, range.y);
  polygon = drawn;
}
)";

}  // namespace radiosity::gl
