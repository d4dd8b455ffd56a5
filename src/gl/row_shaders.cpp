// The shader that sums rows from the pixels of a picture.
#include "gl/shaders.h"

namespace radiosity::gl {

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

}  // namespace radiosity::gl
