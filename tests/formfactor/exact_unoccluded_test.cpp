// Blocks of unoccluded pairs: clipping, sums, bounds, equal bits, and counts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "contour_reference.h"
#include "element_pairs.h"
#include "formfactor/exact/unoccluded/unoccluded.h"
#include "support/mesh_builder.h"
#include "visibility/clipping/flat_polygon.h"

namespace radiosity {
namespace {

using test::ElementPair;
using test::ElementPairs;
using test::MeshBuilder;
using test::Shape;
using Loop = std::vector<Vec3>;

std::size_t total(const UnoccludedCounts& counts) {
  return counts.contour + counts.lambert + counts.product;
}

/// Row sums of all pairs of facets, as if nothing were in between.
std::vector<double> rowSums(const ElementSet& set, const UnoccludedKernel& kernel,
                            UnoccludedCounts& counts) {
  std::vector<double> sums(set.size(), 0);
  for (const Facet& rows : set.facets) {
    for (const Facet& columns : set.facets) {
      if (&rows == &columns) continue;
      std::vector<double> block(std::size_t(rows.elements.size()) * columns.elements.size());
      kernel.block(rows.elements, columns.elements, block.data(), columns.elements.size(), counts);
      for (std::size_t k = 0; k < block.size(); ++k) {
        sums[rows.elements.first + k / columns.elements.size()] += block[k];
      }
    }
  }
  for (std::size_t e = 0; e < set.size(); ++e) sums[e] /= set.area[e];
  return sums;
}

TEST(Unoccluded, RowsOfAClosedRoomSumToOne) {
  MeshBuilder builder;
  builder.box("room", {0, 0, 0}, {1, 1.5, 0.7}, 7, true);
  const ElementSet set(builder.build());
  for (const double tolerance : {1e-2, 1e-3, 1e-5, 1e-7, 1e-11}) {
    UnoccludedCounts counts;
    const UnoccludedKernel kernel(set, tolerance, true);
    for (const double sum : rowSums(set, kernel, counts)) EXPECT_NEAR(sum, 1, tolerance);
    EXPECT_EQ(total(counts), 30U * 49 * 49);
    EXPECT_GT(counts.contour, 0U);
    EXPECT_GT(counts.lambert, 0U);
    EXPECT_GT(counts.product, 0U);
    EXPECT_EQ(counts.clipped, 0U);
  }
}

/// An octahedron around the origin, seen from inside, each face cut into n^2 triangles.
MeshBuilder octahedron(int n) {
  MeshBuilder builder;
  for (int octant = 0; octant < 8; ++octant) {
    const double sx = octant & 1 ? -1 : 1, sy = octant & 2 ? -1 : 1, sz = octant & 4 ? -1 : 1;
    Loop corners = {{sx, 0, 0}, {0, 0, sz}, {0, sy, 0}};
    if (sx * sy * sz < 0) std::swap(corners[1], corners[2]);
    const auto at = [&](int i, int j) {
      return corners[0] + (corners[1] - corners[0]) * (double(i) / n) +
             (corners[2] - corners[0]) * (double(j) / n);
    };
    std::vector<Loop> patches;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        patches.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        if (i + j + 1 < n) patches.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
    builder.polygon("octahedron", {corners}, patches);
  }
  return builder;
}

TEST(Unoccluded, RowsOfAnOctahedronOfTrianglesSumToOne) {
  const ElementSet set(octahedron(5).build());
  ASSERT_EQ(set.size(), 200U);
  for (const double tolerance : {1e-5, 1e-9}) {
    UnoccludedCounts counts;
    for (const double sum : rowSums(set, UnoccludedKernel(set, tolerance, true), counts)) {
      EXPECT_NEAR(sum, 1, tolerance);
    }
    EXPECT_EQ(total(counts), 8U * 7 * 25 * 25);
  }
}

ElementSet setOf(const ElementPair& pair) {
  MeshBuilder builder;
  builder.polygon("a", {pair.a});
  builder.polygon("b", {pair.b});
  return ElementSet(builder.build());
}

TEST(Unoccluded, NearPairsOfAllShapesKeepTheTolerance) {
  ElementPairs pairs(11);
  for (int k = 0; k < 150; ++k) {
    const auto shape = std::array{Shape::square, Shape::parallelogram, Shape::triangle,
                                  Shape::quadrilateral}[std::size_t(k) % 4];
    const double ratio = pairs.logUniform(0.02, 1);
    const ElementPair pair = pairs.next(shape, ratio, pairs.logUniform(0.3, 4));
    const ElementSet set = setOf(pair);
    const double expected = test::referenceExchange(set.outline(0), set.outline(1));
    for (const double tolerance : {1e-2, 1e-3, 1e-5, 1e-7}) {
      const UnoccludedKernel kernel(set, tolerance, true);
      // Contours keep 1e-15 of the larger element's size squared, which is 1 here or less.
      EXPECT_NEAR(kernel.pair(0, 1), expected, tolerance * expected + 1e-15)
          << "pair " << k << ", ratio " << ratio;
      EXPECT_NEAR(kernel.pair(1, 0), expected, tolerance * expected + 1e-15)
          << "pair " << k << ", ratio " << ratio;
    }
  }
}

/// Any two outlines, cut to each other's front half-space.
double clippedReference(const ElementSet& set) {
  const Facet& a = set.facets[set.facet[0]];
  const Facet& b = set.facets[set.facet[1]];
  const FlatPolygon of_a = clipToFront(set.outline(0), b.normal, b.offset);
  const FlatPolygon of_b = clipToFront(set.outline(1), a.normal, a.offset);
  if (of_a.count < 3 || of_b.count < 3) return 0;
  return test::referenceExchange(of_a.outline(), of_b.outline());
}

// As if rounding had moved corners of an element in its cutting plane.
TEST(FlatPolygon, HasRoomForAQuadrilateralWithEverySecondCornerBehindThePlane) {
  const double tiny = 1e-16;
  const std::array<Vec3, 4> outline = {Vec3(0, 0, tiny), Vec3(1, 0, -tiny), Vec3(1, 1, tiny),
                                       Vec3(0, 1, -tiny)};
  const FlatPolygon front = clipToFront(outline, Vec3(0, 0, 1), 0);
  ASSERT_EQ(front.count, 6U);
  EXPECT_EQ(front.count, FlatPolygon::kMostCorners);
  // Two corners and the middles of all four edges.
  Vec3 area(0.0);
  for (std::size_t k = 2; k < front.count; ++k) {
    area += 0.5 * glm::cross(front.corners[k - 1] - front.corners[0],
                             front.corners[k] - front.corners[0]);
  }
  EXPECT_DOUBLE_EQ(area.z, 0.75);
}

TEST(Unoccluded, PairsThatCrossEachOthersPlaneAreClipped) {
  ElementPairs pairs(23);
  int crossing = 0;
  for (int k = 0; k < 200; ++k) {
    ElementPair pair = pairs.next(k % 2 ? Shape::triangle : Shape::quadrilateral,
                                  pairs.logUniform(0.2, 1), pairs.logUniform(1, 6));
    // Sunk into each other's plane.
    const Vec3 down = pairs.uniform(0, 0.8) * pair.normal_a + pairs.uniform(0, 0.8) * pair.normal_b;
    for (Vec3& p : pair.b) p -= down;
    const ElementSet set = setOf(pair);
    const double expected = clippedReference(set);
    const UnoccludedKernel kernel(set, 1e-5, true);
    double value = 0;
    UnoccludedCounts counts;
    kernel.block({0, 1}, {1, 2}, &value, 1, counts);
    crossing += counts.clipped > 0;
    EXPECT_NEAR(value, expected, 1e-5 * expected + 1e-15) << k;
    EXPECT_NEAR(kernel.pair(1, 0), expected, 1e-5 * expected + 1e-15) << k;
  }
  EXPECT_GT(crossing, 50);
}

TEST(Unoccluded, BehindAndCoplanarExchangeNothing) {
  MeshBuilder builder;
  builder.grid("a", {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  builder.grid("coplanar", {2, 0, 0}, {1, 0, 0}, {0, 1, 0});
  builder.grid("behind", {0, 0, -1}, {0, 1, 0}, {1, 0, 0});
  builder.grid("back to back", {0, 0, 1}, {1, 0, 0}, {0, 1, 0});
  const ElementSet set(builder.build());
  const UnoccludedKernel kernel(set, 1e-5, true);
  for (Index column = 1; column < 4; ++column) EXPECT_EQ(kernel.pair(0, column), 0);
}

TEST(Unoccluded, NothingIsNegativeOrLargerThanAnArea) {
  ElementPairs pairs(31);
  for (int k = 0; k < 400; ++k) {
    ElementPair pair = pairs.next(k % 2 ? Shape::sliver : Shape::triangle,
                                  pairs.logUniform(1e-3, 1), pairs.logUniform(1e-3, 1e3));
    const ElementSet set = setOf(pair);
    for (const double tolerance : {1e-5, 1e-8}) {
      const double value = UnoccludedKernel(set, tolerance, true).pair(0, 1);
      EXPECT_GE(value, 0);
      // Rounding of single precision.
      EXPECT_LE(value, std::min(set.area[0], set.area[1]) * (1 + 1e-6));
      EXPECT_TRUE(std::isfinite(value));
    }
  }
}

TEST(Unoccluded, ValuesDoNotDependOnBlocksOrVectors) {
  const ElementSet set(test::roomWithBlock(6).build());
  const UnoccludedKernel simd(set, 1e-5, true);
  const UnoccludedKernel twin(set, 1e-5, false);
  UnoccludedCounts counts;
  for (const Facet& rows : set.facets) {
    for (const Facet& columns : set.facets) {
      if (&rows == &columns) continue;
      const std::size_t width = columns.elements.size();
      // Rows longer than the columns: values in between must stay.
      const std::size_t stride = width + 3;
      std::vector<double> block(rows.elements.size() * stride, -7);
      std::vector<double> scalar(rows.elements.size() * stride, -7);
      simd.block(rows.elements, columns.elements, block.data(), stride, counts);
      twin.block(rows.elements, columns.elements, scalar.data(), stride, counts);
      ASSERT_EQ(0, std::memcmp(block.data(), scalar.data(), block.size() * sizeof(double)));
      for (std::size_t k = 0; k < block.size(); k += 13) {
        const std::size_t column = k % stride;
        if (column >= width) {
          EXPECT_EQ(block[k], -7);
          continue;
        }
        const Index r = rows.elements.first + Index(k / stride);
        ASSERT_EQ(simd.pair(r, columns.elements.first + Index(column)), block[k]);
      }
    }
  }
}

TEST(Unoccluded, MovedAndScaledScenesHaveTheSameValues) {
  const MeshBuilder builder = test::roomWithBlock(2);
  const PatchMesh mesh = builder.build();
  const ElementSet set(mesh);
  PatchMesh moved = mesh;
  // A power of two keeps every bit; the shift, of 1e6 diameters, leaves 1e-10 of each coordinate.
  const auto move = [](Vec3& p) { p = 0.25 * p + Vec3(3e5, -2e5, 1e5); };
  for (Vec3& p : moved.vertices) move(p);
  for (Vec3& p : moved.centroid) move(p);
  for (Vec3& p : moved.polygons.origin) move(p);
  for (double& area : moved.area) area /= 16;
  const ElementSet far(moved);
  ASSERT_EQ(far.size(), set.size());
  const UnoccludedKernel kernel(set, 1e-9, true);
  const UnoccludedKernel far_kernel(far, 1e-9, true);
  for (Index r = 0; r < set.size(); ++r) {
    for (Index c = 0; c < set.size(); ++c) {
      if (set.facet[r] == set.facet[c]) continue;
      EXPECT_NEAR(kernel.pair(r, c) / set.area[r], far_kernel.pair(r, c) / far.area[r], 1e-8);
    }
  }
}

}  // namespace
}  // namespace radiosity
