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

const char* const kSumRows = R"(
layout(std430, binding = 0) readonly buffer Candidates { Candidate candidates[]; };
layout(std430, binding = 1) readonly buffer Grids { Grid grids[]; };
layout(std430, binding = 2) readonly buffer Cells { int cells[]; };
layout(std430, binding = 3) readonly buffer Nodes { Node nodes[]; };
layout(std430, binding = 4) readonly buffer TopSums { uvec2 top_sums[]; };
layout(std430, binding = 5) readonly buffer SideSums { uvec2 side_sums[]; };
layout(std430, binding = 6) buffer Low { uint low[]; };
layout(std430, binding = 7) buffer High { uint high[]; };
uniform uint polygon_count;
uniform int sky;  // its item, the last
uniform bool keep_items;

shared int seen[128];

int itemOf(uint polygon, Pixel pixel) {
  if (polygon == kNone) return sky;
  uint at = gl_WorkGroupID.z * polygon_count + polygon;
  int grid = candidates[at].grid;
  if (grid < 0) return candidates[at].item;
  float w = dot(project(pixel.face, candidates[at].plane.xyz), pixel.ray);
  float u = dot(project(pixel.face, candidates[at].u.xyz), pixel.ray);
  float v = dot(project(pixel.face, candidates[at].v.xyz), pixel.ray);
  float scale = 1 / max(w, 1e-30);  // kLeastW
  int columns = grids[grid].columns;
  int column = int(clamp(roundEven(u * scale), 0, columns - 1));
  int row = int(clamp(roundEven(v * scale), 0, grids[grid].rows - 1));
  int entry = cells[grids[grid].first_cell + row * columns + column];
  while (entry < 0) {
    Node node = nodes[grids[grid].first_node + ~entry];
    entry = node.a * u + node.b * v + node.c * w >= 0 ? node.inside : node.outside;
  }
  return entry;
}

// Adds a number of 64 bits, modulo 2^64, by halves.
void add(int item, uvec2 number) {
  uint at = gl_WorkGroupID.z * uint(sky + 1) + uint(item);
  uint old = atomicAdd(low[at], number.x);
  uint more = number.y + uint(old + number.x < old);
  if (more != 0u) atomicAdd(high[at], more);
}

uvec2 negative(uvec2 number) { return uvec2(~number.x + 1u, ~number.y + uint(number.x == 0u)); }

// A run of pixels of one item is worth the difference of the running sums at its ends.
void main() {
  Pixel pixel = thisPixel();
  int lane = int(gl_LocalInvocationID.x);
  bool inside = pixel.x < resolution;
  int item = inside ? itemOf(imageLoad(picture, pixel.place).x, pixel) : -1;
  seen[lane] = item;
  barrier();
  if (!inside) return;
  if (keep_items) imageStore(picture, pixel.place, uvec4(item));
  bool begins = lane == 0 || seen[lane - 1] != item;
  bool ends = pixel.x == resolution - 1 || lane == 127 || seen[lane + 1] != item;
  int at = sumAt(pixel);
  bool top = pixel.face == 0u;
  if (begins) add(item, negative(top ? top_sums[at] : side_sums[at]));
  if (ends) add(item, top ? top_sums[at + 1] : side_sums[at + 1]);
}
)";

const char* const kMeans = R"(#version 430 core
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer MeanOf { uint mean_of[]; };
layout(std430, binding = 1) readonly buffer FirstOf { uint first_of_mean[]; };
layout(std430, binding = 2) buffer Radiosity { float radiosity[]; };
uniform uint means;
uniform uint eyes;
uniform uint bands;
void main() {
  uint m = gl_GlobalInvocationID.x / bands;
  uint band = gl_GlobalInvocationID.x % bands;
  if (m >= means) return;
  uint first = first_of_mean[m];
  uint end = first_of_mean[m + 1u];
  float base = radiosity[mean_of[first] * bands + band];
  float above = 0;  // differences: a constant field stays that constant
  for (uint k = first; k < end; ++k) above += radiosity[mean_of[k] * bands + band] - base;
  radiosity[(eyes + m) * bands + band] = base + above / float(end - first);
}
)";

const char* const kInterpolate = R"(
struct Facet {
  double area[4];
  uint vertex[4], source[4], count, padding;
};
layout(std430, binding = 0) readonly buffer TopSums { uvec2 top_sums[]; };
layout(std430, binding = 1) readonly buffer SideSums { uvec2 side_sums[]; };
layout(std430, binding = 2) readonly buffer Views { View views[]; };
layout(std430, binding = 3) readonly buffer Vertices { double vertices[]; };
layout(std430, binding = 4) readonly buffer FirstFacet { uint first_facet[]; };
layout(std430, binding = 5) readonly buffer Facets { Facet facets[]; };
layout(std430, binding = 6) readonly buffer Radiosity { float radiosity[]; };
layout(std430, binding = 7) writeonly buffer Parts { double parts[]; };
uniform uint patches;
uniform uint bands;

shared double sums[128];

double worth(uvec2 from, uvec2 to) {
  uint borrow = uint(to.x < from.x);
  return double(to.x - from.x) * 2.168404344971009e-19LF +        // 2^-62
         double(to.y - from.y - borrow) * 9.313225746154785e-10LF;  // 2^-30
}

dvec3 cornerOf(Facet facet, uint k, View view) {
  uint at = 3u * facet.vertex[k];
  return toEye(view, dvec3(vertices[at], vertices[at + 1u], vertices[at + 2u]) - vec(view.eye));
}

// A_k of patch_basis.h at a pixel, up to one factor: det(b, a, r) of an edge's ends.
void edgesOf(Facet facet, View view, Pixel pixel, out double edge[4]) {
  dvec3 first = cornerOf(facet, 0u, view);
  dvec3 corner = first;
  for (uint k = 0u; k < facet.count; ++k) {
    dvec3 next = k + 1u < facet.count ? cornerOf(facet, k + 1u, view) : first;
    edge[k] = dot(project(pixel.face, cross(next - corner, corner)), dvec3(pixel.ray));
    corner = next;
  }
}

// The facet that the pixel lies deepest in, edges measured against their sum, and weights of its
// corners, which sum to 1.
uint facetAt(uint patch_seen, View view, Pixel pixel, out double weight[4]) {
  uint best = first_facet[patch_seen];
  double deepest = -1e300LF;
  double edge[4];
  uint end = first_facet[patch_seen + 1u];
  for (uint f = best; f < end && end - first_facet[patch_seen] > 1u; ++f) {
    edgesOf(facets[f], view, pixel, edge);
    double least = edge[0];
    double sum = edge[0];
    for (uint k = 1u; k < facets[f].count; ++k) {
      least = min(least, edge[k]);
      sum += edge[k];
    }
    double depth = sum > 0 ? least / sum : -1e300LF;
    if (depth > deepest) {
      deepest = depth;
      best = f;
    }
  }
  Facet facet = facets[best];
  edgesOf(facet, view, pixel, edge);
  double total = 0;
  for (uint k = 0u; k < facet.count; ++k) {
    double next = max(edge[(k + 1u) % facet.count], 0.0LF);
    double after = max(edge[(k + 2u) % facet.count], 0.0LF);
    weight[k] = facet.count == 4u ? facet.area[k] * next * after : next;
    total += weight[k];
  }
  for (uint k = 0u; k < facet.count; ++k) weight[k] = total > 0 ? weight[k] / total : double(k == 0u);
  return best;
}

void main() {
  Pixel pixel = thisPixel();
  uint lane = gl_LocalInvocationID.x;
  uint item = pixel.x < resolution ? imageLoad(picture, pixel.place).x : kNone;
  bool lit = item < patches;
  double pixel_worth = 0;
  double weight[4];
  uint facet = 0u;
  if (lit) {
    int at = sumAt(pixel);
    pixel_worth = pixel.face == 0u ? worth(top_sums[at], top_sums[at + 1])
                                   : worth(side_sums[at], side_sums[at + 1]);
    facet = facetAt(item, views[gl_WorkGroupID.z], pixel, weight);
  }
  uint row = (gl_WorkGroupID.z * gl_NumWorkGroups.y + gl_WorkGroupID.y) * gl_NumWorkGroups.x +
             gl_WorkGroupID.x;
  for (uint band = 0u; band < bands; ++band) {
    double value = 0;
    if (lit) {
      float base = radiosity[facets[facet].source[0] * bands + band];
      double above = 0;  // differences: a constant field stays that constant
      for (uint k = 1u; k < facets[facet].count; ++k) {
        above += weight[k] * double(radiosity[facets[facet].source[k] * bands + band] - base);
      }
      value = pixel_worth * (double(base) + above);
    }
    sums[lane] = value;
    barrier();
    for (uint step = 64u; step > 0u; step /= 2u) {
      if (lane < step) sums[lane] += sums[lane + step];
      barrier();
    }
    if (lane == 0u) parts[row * bands + band] = sums[0];
    barrier();
  }
}
)";

const char* const kGather = R"(
layout(local_size_x = 128) in;
layout(std430, binding = 0) readonly buffer Low { uint low[]; };
layout(std430, binding = 1) readonly buffer High { uint high[]; };
layout(std430, binding = 2) readonly buffer Views { View views[]; };
layout(std430, binding = 3) readonly buffer Radiosity { float radiosity[]; };
layout(std430, binding = 4) readonly buffer Parts { double parts[]; };
layout(std430, binding = 5) readonly buffer Materials { float materials[]; };
layout(std430, binding = 6) writeonly buffer Irradiance { double irradiance[]; };
layout(std430, binding = 7) writeonly buffer Next { float next[]; };
uniform uint patches;
uniform uint items;
uniform uint bands;
uniform uint eyes;
uniform uint part_count;  // a view; 0: patches have one radiosity

shared double sums[128];

double weightOf(uint item) {
  uint at = gl_WorkGroupID.x * (items + 1u) + item;
  return double(high[at]) * 9.313225746154785e-10LF + double(low[at]) * 2.168404344971009e-19LF;
}

// In a fixed order, whatever the device.
double gathered(uint lane, uint band) {
  double sum = 0;
  if (part_count > 0u) {
    for (uint k = lane; k < part_count; k += 128u) {
      sum += parts[(gl_WorkGroupID.x * part_count + k) * bands + band];
    }
  } else {
    for (uint k = lane; k < patches; k += 128u) sum += weightOf(k) * double(radiosity[k * bands + band]);
  }
  return sum;
}

void main() {
  uint lane = gl_LocalInvocationID.x;
  for (uint band = 0u; band < bands; ++band) {
    sums[lane] = gathered(lane, band);
    barrier();
    for (uint step = 64u; step > 0u; step /= 2u) {
      if (lane < step) sums[lane] += sums[lane + step];
      barrier();
    }
    if (lane == 0u) {
      irradiance[gl_WorkGroupID.x * bands + band] = sums[0];
      uint at = views[gl_WorkGroupID.x].source * bands + band;
      // Emission, reflectance, and what an open sky gives.
      uint all = eyes * bands;
      double received = sums[0] + weightOf(items) * double(materials[2u * all + band]);
      next[at] = float(double(materials[at]) + double(materials[all + at]) * received);
    }
    barrier();
  }
}
)";

}  // namespace radiosity::gl
