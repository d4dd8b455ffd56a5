// The shaders that gather light: means, interpolation at pixels, sums.
#include "gl/shaders.h"

namespace radiosity::gl {

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
      // Sums of differences may end a rounding error below 0.
      double seen = max(sums[0], 0.0LF);
      irradiance[gl_WorkGroupID.x * bands + band] = seen;
      uint at = views[gl_WorkGroupID.x].source * bands + band;
      // Emission, reflectance, and what an open sky gives.
      uint all = eyes * bands;
      double received = seen + weightOf(items) * double(materials[2u * all + band]);
      next[at] = float(double(materials[at]) + double(materials[all + at]) * received);
    }
    barrier();
  }
}
)";

}  // namespace radiosity::gl
