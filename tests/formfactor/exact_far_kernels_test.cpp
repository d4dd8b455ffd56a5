// The vector kernels of distant pairs: the same bits on every instruction set, and the published
// accuracy against contour integrals in long double.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <type_traits>

#include "contour_reference.h"
#include "element_pairs.h"
#include "formfactor/exact/unoccluded/far_kernels.h"
#include "support/simd_targets.h"

namespace radiosity {
namespace {

using test::ElementPair;
using test::ElementPairs;
using test::Shape;

template <class Check>
void forEveryFarTarget(const Check& check) {
  test::onEveryTarget([] { return farKernels(true); }, check);
}

template <class T>
FarFunction<T> functionOf(const FarKernels& kernels) {
  if constexpr (std::is_same_v<T, float>) {
    return kernels.single_precision;
  } else {
    return kernels.double_precision;
  }
}

FacetFrame frameOf(const std::vector<Vec3>& outline, const Vec3& normal) {
  const Vec3 u = glm::normalize(outline[1] - outline[0]);
  return {u, glm::cross(normal, u), normal, glm::dot(normal, outline[0])};
}

/// The kernel's value of one pair.
template <class T>
double farValue(const FarKernels& kernels, const ElementPair& pair, double tolerance) {
  const FacetFrame row_frame = frameOf(pair.a, pair.normal_a);
  const FacetFrame column_frame = frameOf(pair.b, pair.normal_b);
  const FlatShape row_shape = flatShape(pair.a, row_frame);
  const FlatShape column_shape = flatShape(pair.b, column_frame);
  const FarLimits limits(tolerance);
  FarColumns<T> columns(1);
  columns.set(0, column_shape, limits.of(column_shape));
  std::vector<T> heights(1 + kFarPadding, T(0));
  heights[0] = T(glm::dot(row_frame.normal, column_shape.centroid) - row_frame.offset);
  std::vector<T> values(1 + kFarPadding);
  FarRow<T> row(row_shape, row_frame, column_frame, limits.of(row_shape));
  const auto near = functionOf<T>(kernels)(row, {&columns, 0, 1, heights.data(), values.data()},
                                           limits.template rules<T>());
  EXPECT_EQ(near, values[0] == T(kNearPair) ? 1U : 0U);
  return values[0];
}

struct Row {
  Shape shape;
  const char* name;
};
constexpr std::array<Row, 5> kShapes = {{{Shape::square, "squares"},
                                         {Shape::parallelogram, "parallelograms"},
                                         {Shape::sliver, "slivers"},
                                         {Shape::triangle, "triangles"},
                                         {Shape::quadrilateral, "quadrilaterals"}}};

/// Pairs with their values; made once.
struct Sample {
  ElementPair pair;
  double value;
};
const std::vector<Sample>& samples(std::size_t shape) {
  static std::array<std::vector<Sample>, kShapes.size()> all;
  std::vector<Sample>& own = all[shape];
  if (!own.empty()) return own;
  ElementPairs pairs(7 + shape);
  while (own.size() < 150) {
    const double ratio = pairs.logUniform(0.1, 1);
    const double distance = pairs.logUniform(2.5, 60);
    const ElementPair pair = pairs.next(kShapes[shape].shape, ratio, distance);
    const double value = test::referenceExchange(pair.a, pair.b);
    // The reference is good to about 1e-18: to ten digits here.
    if (value > 1e-8) own.push_back({pair, value});
  }
  return own;
}

TEST(FarKernels, TheTableOfAccuracyIsKeptOnEveryInstructionSet) {
  forEveryFarTarget([](const FarKernels& kernels) {
    for (std::size_t s = 0; s < kShapes.size(); ++s) {
      for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-7, 1e-9}) {
        const bool single = tolerance >= 1e-5;
        double worst = 0;
        int far = 0;
        for (const Sample& sample : samples(s)) {
          const double value = single ? farValue<float>(kernels, sample.pair, tolerance)
                                      : farValue<double>(kernels, sample.pair, tolerance);
          if (value == kNearPair) continue;
          ++far;
          worst = std::max(worst, std::abs(value / sample.value - 1));
        }
        EXPECT_GT(far, 20) << kShapes[s].name;
        // The formulas' errors are below the tolerance; single precision adds its own, 1e-6.
        EXPECT_LE(worst, tolerance + (single ? 1e-6 : 1e-12))
            << kShapes[s].name << " at " << tolerance << " on " << kernels.target;
      }
    }
  });
}

/// Rows of many columns; their number is no multiple of any vector.
template <class T>
std::vector<T> manyValues(const FarKernels& kernels, std::size_t first, std::size_t count,
                          std::size_t& near) {
  ElementPairs pairs(3);
  const Vec3 normal(0, 0, 1);
  const FacetFrame row_frame{{1, 0, 0}, {0, 1, 0}, normal, 0};
  const FacetFrame column_frame{{1, 0, 0}, {0, 0.8, 0.6}, {0, 0.6, -0.8}, -3};
  const FarLimits limits(sizeof(T) == 4 ? 1e-5 : 1e-8);
  FarColumns<T> columns(first + count);
  std::vector<T> heights(count + kFarPadding, T(0));
  for (std::size_t k = 0; k < first + count; ++k) {
    const double size = pairs.logUniform(0.01, 3);
    const Vec3 middle = pairs.uniform(-3, 3) * column_frame.u +
                        pairs.uniform(-2, 3) * column_frame.v + Vec3(0, -1.8, 2.4);
    std::vector<Vec3> outline = {middle, middle + size * column_frame.v,
                                 middle + size * (column_frame.v + 1.5 * column_frame.u),
                                 middle + size * column_frame.u};
    if (k % 3 == 0) outline.pop_back();
    std::reverse(outline.begin(), outline.end());
    const FlatShape shape = flatShape(outline, column_frame);
    columns.set(k, shape, limits.of(shape));
    if (k >= first) heights[k - first] = T(shape.centroid.z);
  }
  const std::vector<Vec3> outline = {{0, 0, 0}, {0.3, 0, 0}, {0.3, 0.2, 0}, {0, 0.2, 0}};
  const FlatShape shape = flatShape(outline, row_frame);
  FarRow<T> row(shape, row_frame, column_frame, limits.of(shape));
  std::vector<T> values(count + kFarPadding);
  near = functionOf<T>(kernels)(row, {&columns, first, count, heights.data(), values.data()},
                                limits.template rules<T>());
  values.resize(count);
  return values;
}

template <class T>
void expectTheScalarTargetsBits(const FarKernels& kernels) {
  for (const std::size_t count : {1U, 3U, 16U, 37U, 200U}) {
    std::size_t near = 0;
    std::size_t expected_near = 0;
    const auto values = manyValues<T>(kernels, 5, count, near);
    const auto expected = manyValues<T>(farKernels(false), 5, count, expected_near);
    EXPECT_EQ(near, expected_near);
    if (count == 200) {
      EXPECT_GT(near, 0U);
      EXPECT_LT(near, count / 2);
    }
    for (std::size_t k = 0; k < count; ++k) {
      using Word = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
      ASSERT_EQ(std::bit_cast<Word>(values[k]), std::bit_cast<Word>(expected[k])) << k;
    }
  }
}

TEST(FarKernels, EveryInstructionSetHasTheSameBits) {
  forEveryFarTarget([](const FarKernels& kernels) {
    expectTheScalarTargetsBits<float>(kernels);
    expectTheScalarTargetsBits<double>(kernels);
  });
}

TEST(FarKernels, ShapesHaveTheMomentsAndCornersOfTheirOutline) {
  ElementPairs pairs(1);
  for (const Row& row : kShapes) {
    const ElementPair pair = pairs.next(row.shape, 1, 5);
    const FacetFrame frame = frameOf(pair.a, pair.normal_a);
    const FlatShape shape = flatShape(pair.a, frame);
    // Moments by the triangles of a fan: of a triangle the mean of d d^T is that of its three edge
    // middles.
    double area = 0;
    Vec3 first(0.0);
    double uu = 0, uv = 0, vv = 0;
    for (std::size_t k = 1; k + 1 < pair.a.size(); ++k) {
      const Vec3 &a = pair.a[0], &b = pair.a[k], &c = pair.a[k + 1];
      const double part = glm::length(glm::cross(b - a, c - a)) / 2;
      area += part;
      first += part / 3 * (a + b + c);
      for (const Vec3& m : {(a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5}) {
        const Vec2 d(glm::dot(m - shape.centroid, frame.u), glm::dot(m - shape.centroid, frame.v));
        uu += part / 3 * d.x * d.x;
        uv += part / 3 * d.x * d.y;
        vv += part / 3 * d.y * d.y;
      }
    }
    EXPECT_NEAR(shape.area, area, 1e-14) << row.name;
    EXPECT_LT(glm::distance(shape.centroid, first / area), 1e-14) << row.name;
    EXPECT_NEAR(shape.p.x * shape.p.x, uu / area, 1e-14) << row.name;
    EXPECT_NEAR(shape.p.x * shape.p.y, uv / area, 1e-14) << row.name;
    EXPECT_NEAR(shape.p.y * shape.p.y + shape.q * shape.q, vv / area, 1e-14) << row.name;
    EXPECT_NEAR(shape.moment, (uu + vv) / area, 1e-14) << row.name;
    // The map meets the corners.
    const Vec2 corner = shape.mean - shape.u - shape.v + shape.w;
    const Vec3 at = shape.centroid + corner.x * frame.u + corner.y * frame.v;
    EXPECT_LT(glm::distance(at, pair.a[0]), 1e-14) << row.name;
  }
}

}  // namespace
}  // namespace radiosity
