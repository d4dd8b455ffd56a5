// The kernels over rows of the triangle on every instruction set, against their definition.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "matrix/run_row.h"
#include "matrix/triangle_kernels.h"
#include "support/simd_targets.h"

namespace radiosity {
namespace {

template <class Check>
void forEveryTarget(const Check& check) {
  test::onEveryTarget(triangleKernels, check);
}

struct Sample {
  std::vector<double> dense;
  RunRow row;
  std::size_t stride;
  std::vector<double> x;
  std::vector<double> z;
  std::vector<double> factor;

  /// Runs of 1 to about 40 values with gaps of 1 to about 40, `n` places in all.
  Sample(std::size_t n, Precision precision, unsigned seed)
      : dense(n), stride(n + kOverrun), x(kMaxBands * stride), z(kMaxBands * stride), factor(4) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.5, 2.0);
    bool inside = false;
    for (double& value : dense) {
      if (random() % 20 == 0) inside = !inside;
      value = inside ? (random() % 3 == 0 ? -1 : 1) * uniform(random) : 0.0;
    }
    row = packRuns(dense, precision);
    for (double& value : x) value = uniform(random);
    for (double& value : z) value = uniform(random);
    for (double& value : factor) value = uniform(random);
  }
  RowOperands operands(std::vector<double>& target, int bands) const {
    return {
        .x = x.data(), .x_stride = stride, .z = target.data(), .z_stride = stride, .bands = bands};
  }
  /// sums[b] by the definition in triangle_kernels.h.
  double gathered(int band) const {
    double sums[kSums] = {};
    forRuns(row, [&](std::size_t offset, const auto* values, std::size_t count) {
      for (std::size_t m = 0; m < count; ++m) {
        sums[m % kSums] += double(values[m]) * x[std::size_t(band) * stride + offset + m];
      }
    });
    const double* s = sums;
    return ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]));
  }
  std::vector<double> handedOn(int bands) const {
    std::vector<double> out = z;
    for (int b = 0; b < bands; ++b) {
      forRuns(row, [&](std::size_t offset, const auto* values, std::size_t count) {
        for (std::size_t m = 0; m < count; ++m) {
          out[std::size_t(b) * stride + offset + m] += double(values[m]) * factor[std::size_t(b)];
        }
      });
    }
    return out;
  }
};

TEST(TriangleKernels, EveryInstructionSetGivesTheBitsOfTheDefinition) {
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    for (std::size_t n = 0; n < 130; n += n < 20 ? 1 : 11) {
      const Sample sample(n, precision, unsigned(n));
      forEveryTarget([&](const TriangleKernels& kernels) {
        for (int bands = 1; bands <= kMaxBands; ++bands) {
          std::vector<double> z = sample.z;
          std::vector<double> sums(kMaxBands, -1.0);
          kernels.gather(sample.row, sample.operands(z, bands), sums.data());
          EXPECT_EQ(z, sample.z);
          for (int b = 0; b < kMaxBands; ++b) {
            EXPECT_EQ(sums[std::size_t(b)], b < bands ? sample.gathered(b) : -1.0) << n;
          }
          kernels.hand_on(sample.row, sample.operands(z, bands), sample.factor.data());
          EXPECT_EQ(z, sample.handedOn(bands)) << n;
          std::vector<double> both_z = sample.z;
          std::vector<double> both_sums(kMaxBands, -1.0);
          kernels.gather_and_hand_on(sample.row, sample.operands(both_z, bands),
                                     sample.factor.data(), both_sums.data());
          EXPECT_EQ(both_z, z);
          EXPECT_EQ(both_sums, sums);
        }
      });
    }
  }
}

TEST(RunRow, HoldsEveryValueAndLeavesZerosOut) {
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    for (unsigned seed = 0; seed < 20; ++seed) {
      const Sample sample(300, precision, seed);
      RunReader reader(sample.row);
      std::size_t stored = 0;
      for (std::size_t m = 0; m < 300; ++m) {
        const double value = sample.dense[m];
        EXPECT_EQ(reader.at(m),
                  precision == Precision::single_precision ? double(float(value)) : value);
        stored += value != 0 ? 1 : 0;
      }
      std::size_t values = 0;
      forRuns(sample.row, [&](std::size_t, const auto*, std::size_t count) { values += count; });
      EXPECT_LE(values, stored + sample.row.runs.size());  // single zeros between floats are stored
      EXPECT_EQ(RunReader(sample.row).at(299), reader.at(299));
    }
  }
  EXPECT_EQ(bytesOf(packRuns(std::vector<double>(1000, 0.0), Precision::single_precision)), 0u);
  // 1e-60 is 0 as a float.
  EXPECT_EQ(bytesOf(packRuns(std::vector<double>(1000, 1e-60), Precision::single_precision)), 0u);
}

}  // namespace
}  // namespace radiosity
