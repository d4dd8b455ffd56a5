// The kernels over rows of the triangle on every instruction set, against their definition.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "matrix/operands.h"
#include "matrix/run_row.h"
#include "matrix/triangle_kernels.h"
#include "support/simd_targets.h"

namespace radiosity {
namespace {

template <class Check>
void forEveryTarget(const Check& check) {
  test::onEveryTarget(triangleKernels, check);
}

/// Runs of 1 to about `length` values with gaps of 1 to about 40, `n` places in all.
std::vector<double> someRuns(std::size_t n, unsigned length, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0.5, 2.0);
  std::vector<double> values(n);
  bool inside = false;
  for (double& value : values) {
    if (random() % (inside ? length / 2 : 20) == 0) inside = !inside;
    value = inside ? (random() % 3 == 0 ? -1 : 1) * uniform(random) : 0.0;
  }
  return values;
}

/// Consecutive rows of a triangle that begin at place `first` and end at the same one.
struct Block {
  std::vector<RunRow> rows;
  std::size_t first;
  std::size_t stride;
  std::vector<double> x;
  std::vector<double> z;
  std::vector<double> factor;

  /// The first row has `n` places, each next one less.
  Block(std::size_t count, std::size_t n, unsigned length, std::size_t at, Precision precision,
        unsigned seed)
      : first(at),
        stride(first + n + kOverrun),
        x(kMaxBands * stride),
        z(kMaxBands * stride),
        factor(kMaxRows * kMaxBands) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.5, 2.0);
    for (std::size_t r = 0; r < count; ++r) {
      rows.push_back(packRuns(someRuns(n > r ? n - r : 0, length, random), precision));
    }
    for (double& value : x) value = uniform(random);
    for (double& value : z) value = uniform(random);
    for (double& value : factor) value = uniform(random);
  }
  RowBlock block() const { return {.rows = rows, .first = first}; }
  RowOperands operands(std::vector<double>& target, int bands) const {
    return {
        .x = x.data(), .x_stride = stride, .z = target.data(), .z_stride = stride, .bands = bands};
  }
  /// sums[r * bands + b] by the definition in triangle_kernels.h, -1 beyond.
  std::vector<double> gathered(int bands) const {
    std::vector<double> all(kMaxRows * kMaxBands, -1.0);
    for (std::size_t m = 0; m < rows.size() * std::size_t(bands); ++m) {
      const std::size_t r = m / std::size_t(bands);
      double s[kSums] = {};
      forRuns(rows[r], [&](std::size_t offset, const auto* values, std::size_t count) {
        for (std::size_t k = 0; k < count; ++k) {
          const std::size_t place = first + r + offset + k;
          double& sum = s[place % kSums];
          sum = std::fma(double(values[k]), x[m % std::size_t(bands) * stride + place], sum);
        }
      });
      all[m] = ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]));
    }
    return all;
  }
  std::vector<double> handedOn(int bands) const {
    std::vector<double> out = z;
    for (std::size_t m = 0; m < rows.size() * std::size_t(bands); ++m) {
      const std::size_t r = m / std::size_t(bands);
      double* to = &out[m % std::size_t(bands) * stride + first + r];
      forRuns(rows[r], [&](std::size_t offset, const auto* values, std::size_t count) {
        for (std::size_t k = 0; k < count; ++k) {
          to[offset + k] = std::fma(double(values[k]), factor[m], to[offset + k]);
        }
      });
    }
    return out;
  }
};

void expectTheBitsOfTheDefinition(const TriangleKernels& kernels, const Block& sample, int bands) {
  const std::vector<double> gathered = sample.gathered(bands);
  const std::vector<double> handed = sample.handedOn(bands);
  const std::vector<double> untouched(gathered.size(), -1.0);
  std::vector<double> z = sample.z;
  std::vector<double> sums = untouched;
  kernels.gather(sample.block(), sample.operands(z, bands), sums.data());
  EXPECT_EQ(z, sample.z);
  EXPECT_EQ(sums, gathered);
  kernels.scatter(sample.block(), sample.operands(z, bands), sample.factor.data());
  EXPECT_EQ(z, handed);
  z = sample.z;
  sums = untouched;
  kernels.gather_and_scatter(sample.block(), sample.operands(z, bands), sample.factor.data(),
                             sums.data());
  EXPECT_EQ(z, handed);
  EXPECT_EQ(sums, gathered);
}

TEST(TriangleKernels, EveryInstructionSetGivesTheBitsOfTheDefinition) {
  forEveryTarget([](const TriangleKernels& kernels) {
    for (const Precision precision : test::kPrecisions) {
      for (std::size_t n = 0; n < 130; n += n < 20 ? 1 : 11) {
        const Block sample(1, n, 40, n % kSums, precision, unsigned(n));
        for (int bands = 1; bands <= kMaxBands; ++bands) {
          expectTheBitsOfTheDefinition(kernels, sample, bands);
        }
      }
    }
  });
}

// Runs of about 600 values leave stretches of some hundred places that all rows share, longer and
// shorter than a tile; runs of about 40 leave none.
TEST(TriangleKernels, RowsAtOnceGiveTheBitsOfRowsOneByOne) {
  forEveryTarget([](const TriangleKernels& kernels) {
    unsigned seed = 0;
    for (const Precision precision : test::kPrecisions) {
      for (const unsigned length : {40U, 600U, 100000U}) {
        for (const std::size_t count : {std::size_t(3), kMaxRows - 1, kMaxRows}) {
          const Block sample(count, 1500, length, 1 + seed % kSums, precision, seed);
          for (int bands = 1; bands <= kMaxBands; ++bands) {
            expectTheBitsOfTheDefinition(kernels, sample, bands);
          }
          ++seed;
        }
      }
    }
  });
}

TEST(RunRow, HoldsEveryValueAndLeavesZerosOut) {
  for (const Precision precision : test::kPrecisions) {
    for (unsigned seed = 0; seed < 20; ++seed) {
      std::mt19937 random(seed);
      const std::vector<double> dense = someRuns(300, 40, random);
      const RunRow row = packRuns(dense, precision);
      RunReader reader(row);
      std::size_t stored = 0;
      for (std::size_t m = 0; m < 300; ++m) {
        const double value = dense[m];
        EXPECT_EQ(reader.at(m),
                  precision == Precision::single_precision ? double(float(value)) : value);
        stored += value != 0 ? 1 : 0;
      }
      std::size_t values = 0;
      forRuns(row, [&](std::size_t, const auto*, std::size_t count) { values += count; });
      EXPECT_LE(values, stored + row.runs.size());  // single zeros between floats are stored
      EXPECT_EQ(RunReader(row).at(299), reader.at(299));
    }
  }
  EXPECT_EQ(bytesOf(packRuns(std::vector<double>(1000, 0.0), Precision::single_precision)), 0u);
  // 1e-60 is 0 as a float.
  EXPECT_EQ(bytesOf(packRuns(std::vector<double>(1000, 1e-60), Precision::single_precision)), 0u);
}

}  // namespace
}  // namespace radiosity
