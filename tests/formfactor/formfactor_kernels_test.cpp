// Every instruction set of this machine against the scalar twin, bit for bit.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "base/aligned_buffer.h"
#include "formfactor/hemicube/raster_kernels.h"
#include "radiosity/form_factors.h"
#include "support/mesh_builder.h"
#include "support/simd_targets.h"

namespace radiosity {
namespace {

template <class Check>
int forEveryTarget(const Check& check) {
  return test::onEveryTarget(simdKernels, check);
}

void expectSameBits(const float* a, const float* b, std::size_t count) {
  for (std::size_t x = 0; x < count; ++x) {
    ASSERT_EQ(std::bit_cast<std::uint32_t>(a[x]), std::bit_cast<std::uint32_t>(b[x])) << x;
  }
}

constexpr int kWidth = 50;  // not a multiple of any vector
constexpr int kStride = 64;
constexpr int kRows = 20;
constexpr std::size_t kPixels = std::size_t(kStride) * kRows;

struct Picture {
  Picture() {
    depth.reserve(kPixels);
    items.reserve(kPixels + kRowAlignment);
  }
  FillTarget target() { return {depth.data(), items.data(), kStride, 0.5F - kWidth / 2.0F}; }
  AlignedBuffer<float> depth;
  AlignedBuffer<std::uint32_t> items;
};

void drawRandomSpans(const RasterKernels& kernels, Picture& picture) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<float> slope(-1, 1);
  kernels.clear(picture.depth.data(), picture.items.data(), kPixels);
  for (std::uint32_t item = 0; item < 40; ++item) {
    std::vector<Span> spans;
    for (int y = 0; y < kRows; ++y) {
      int begin = int(random() % (kWidth + 1));
      int end = int(random() % (kWidth + 1));
      if (begin > end) std::swap(begin, end);
      if (begin < end) spans.push_back({y, begin, end, 3 * slope(random)});
    }
    kernels.fill(picture.target(), spans.data(), spans.size(), slope(random), item);
  }
}

TEST(Kernels, FillAndClearAgreeToTheBit) {
  Picture expected;
  drawRandomSpans(scalarKernels(), expected);
  const int targets = forEveryTarget([&](const RasterKernels& kernels) {
    Picture picture;
    drawRandomSpans(kernels, picture);
    expectSameBits(expected.depth.data(), picture.depth.data(), kPixels);
    for (std::size_t x = 0; x < kPixels; ++x) {
      ASSERT_EQ(expected.items.data()[x], picture.items.data()[x]);
    }
  });
  EXPECT_GE(targets, 1);
}

TEST(Kernels, FillTouchesOnlyItsSpanAndKeepsTheFirstOfEquals) {
  forEveryTarget([&](const RasterKernels& kernels) {
    Picture picture;
    kernels.clear(picture.depth.data(), picture.items.data(), kPixels);
    const Span span{3, 5, 37, 1.0F};
    kernels.fill(picture.target(), &span, 1, 0.0F, 1);
    kernels.fill(picture.target(), &span, 1, 0.0F, 2);  // as deep: stays hidden
    const Span nearer{3, 20, 21, 2.0F};
    kernels.fill(picture.target(), &nearer, 1, 0.0F, 3);
    const Span farther{3, 10, 15, 0.5F};
    kernels.fill(picture.target(), &farther, 1, 0.0F, 4);
    for (int y = 0; y < kRows; ++y) {
      for (int x = 0; x < kStride; ++x) {
        std::uint32_t item = kSky;
        if (y == 3 && x >= 5 && x < 37) item = x == 20 ? 3 : 1;
        ASSERT_EQ(picture.items.data()[y * kStride + x], item) << x << " " << y;
      }
    }
  });
}

TEST(Kernels, FillTakesEveryDepthAboveMinusInfinity) {
  // Inverse depths may round to 0 or below near the horizon; such pixels are not sky.
  forEveryTarget([&](const RasterKernels& kernels) {
    Picture picture;
    kernels.clear(picture.depth.data(), picture.items.data(), kPixels);
    const Span span{0, 0, kWidth, -1e30F};
    kernels.fill(picture.target(), &span, 1, 0.0F, 1);
    for (int x = 0; x < kWidth; ++x) ASSERT_EQ(picture.items.data()[x], 1u);
  });
}

TEST(Kernels, RunsAgree) {
  std::mt19937_64 random(5);
  AlignedBuffer<std::uint32_t> values;
  values.reserve(kStride);
  std::int32_t expected[kStride + kRowAlignment];
  std::int32_t starts[kStride + kRowAlignment];
  for (const int changes : {1, 2, 5, 50}) {
    for (int count = 1; count <= kWidth; ++count) {
      for (int x = 0; x < kStride; ++x) {
        values.data()[x] = std::uint32_t(random() % std::uint64_t(changes));
      }
      const std::size_t n = scalarKernels().findRuns(values.data(), count, expected);
      forEveryTarget([&](const RasterKernels& kernels) {
        ASSERT_EQ(n, kernels.findRuns(values.data(), count, starts));
        ASSERT_EQ(0, std::memcmp(expected, starts, n * sizeof *starts));
      });
    }
  }
}

struct CellRuns {
  std::int32_t starts[kStride + kRowAlignment];
  std::int32_t cells[kStride + kRowAlignment];
};

TEST(Kernels, CellsAgreeAlsoOutsideTheGrid) {
  std::mt19937_64 random(9);
  std::normal_distribution<float> normal;
  for (int k = 0; k < 400; ++k) {
    RowMap map{normal(random),
               10 * normal(random),
               normal(random),
               10 * normal(random),
               k % 3 ? 0.0F : normal(random),
               5 * normal(random),
               0.5F - kWidth / 2.0F,
               2,
               1,
               3,
               7};
    if (k == 8) map.w_slope = map.w = 0;
    if (k == 9) map.last_column = map.last_row = 0;
    CellRuns expected;
    CellRuns found;
    const std::size_t n = scalarKernels().locate(map, 3, kWidth, expected.starts, expected.cells);
    ASSERT_EQ(3, expected.starts[0]);
    for (std::size_t r = 0; r < n; ++r) {
      ASSERT_GE(expected.cells[r], 7);
      ASSERT_LE(expected.cells[r], 12);
      if (r > 0) {
        ASSERT_NE(expected.cells[r], expected.cells[r - 1]);
        ASSERT_GT(expected.starts[r], expected.starts[r - 1]);
      }
    }
    forEveryTarget([&](const RasterKernels& kernels) {
      ASSERT_EQ(n, kernels.locate(map, 3, kWidth, found.starts, found.cells)) << k;
      for (std::size_t r = 0; r < n; ++r) {
        ASSERT_EQ(expected.starts[r], found.starts[r]);
        ASSERT_EQ(expected.cells[r], found.cells[r]);
      }
    });
  }
}

TEST(Kernels, EdgesCrossRowsAlike) {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> unit(-10, 60);
  for (int k = 0; k < 300; ++k) {
    const int first = int(random() % 20);
    const EdgeRows edge{
        unit(random), unit(random), unit(random) / 20, first, first + int(random() % 20), kWidth};
    std::int32_t expected[20];
    scalarKernels().cross(edge, expected);
    for (int y = edge.first; y < edge.end; ++y) {
      // The definition: all centres left of the edge are left out, no other.
      const double x = edge.low_x + ((y + 0.5) - edge.low_y) * edge.slope;
      const int pixel = expected[y - first];
      ASSERT_TRUE(pixel == 0 || pixel - 0.5 < x);
      ASSERT_TRUE(pixel == kWidth || pixel + 0.5 >= x);
    }
    forEveryTarget([&](const RasterKernels& kernels) {
      std::int32_t found[21];
      found[edge.end - first] = -7;
      kernels.cross(edge, found);
      EXPECT_EQ(found[edge.end - first], -7);  // nothing written past the last row
      for (int y = 0; y < edge.end - first; ++y) ASSERT_EQ(expected[y], found[y]);
    });
  }
}

TEST(Kernels, CellsAreTheOnesTheCoordinatesFallInto) {
  // u = x + 0.5 (pixel centres), v = 1.25: column x, row 1 of a grid of 50 x 2.
  RowMap map{1, kWidth / 2.0F - 0.5F, 0, 0.75F, 0, 1, 0.5F - kWidth / 2.0F, 49, 1, 50, 3};
  CellRuns runs;
  ASSERT_EQ(50u, scalarKernels().locate(map, 0, kWidth, runs.starts, runs.cells));
  for (int x = 0; x < kWidth; ++x) {
    EXPECT_EQ(runs.starts[x], x);
    EXPECT_EQ(runs.cells[x], 3 + 50 + x);
  }
}

TEST(Kernels, WholeRowsAgreeOnEveryInstructionSet) {
  // Triangular patches: the trees of lines are used, too.
  test::MeshBuilder builder;
  builder.box("room", {0, 0, 0}, {1, 1, 1}, 3, true);
  builder.polygon("plate", {{{0.2, 0.2, 0.5}, {0.8, 0.2, 0.5}, {0.8, 0.8, 0.5}, {0.2, 0.8, 0.5}}},
                  {{{0.2, 0.2, 0.5}, {0.8, 0.2, 0.5}, {0.5, 0.4, 0.5}},
                   {{0.8, 0.2, 0.5}, {0.8, 0.8, 0.5}, {0.5, 0.4, 0.5}},
                   {{0.8, 0.8, 0.5}, {0.2, 0.8, 0.5}, {0.5, 0.4, 0.5}},
                   {{0.2, 0.8, 0.5}, {0.2, 0.2, 0.5}, {0.5, 0.4, 0.5}}});
  const PatchMesh mesh = builder.build();
  FormFactorOptions options;
  options.method = FormFactorMethod::hemicube;
  options.resolution = 50;
  options.precision = Precision::double_precision;
  options.simd = false;
  Progress silent;
  const FormFactors expected = computeFormFactors(mesh, options, silent);
  options.simd = true;
  forEveryTarget([&](const RasterKernels& kernels) {
    const FormFactors f = computeFormFactors(mesh, options, silent);
    EXPECT_EQ(f.report.simd_target, kernels.target);
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      for (std::size_t j = 0; j < mesh.size(); ++j) {
        ASSERT_EQ(expected.matrix.at(i, j), f.matrix.at(i, j));
      }
    }
  });
}

}  // namespace
}  // namespace radiosity
