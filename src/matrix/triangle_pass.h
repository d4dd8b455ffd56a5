// A pass over the triangle, by many threads, in which every row hands something on to later ones.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/parallel.h"

namespace radiosity {

/// Rows handed on by different threads meet in the same places. So rows are dealt out in chunks of
/// about equal work, each with sums of its own, which are added up in order. The chunks depend on
/// the work alone, never on the threads: the same bits for any number of them.
class TrianglePass {
 public:
  /// `work(k)`: of row k, in any unit. `overrun`: so many places after the last row may be touched.
  template <class Work>
  TrianglePass(std::size_t rows, std::size_t overrun, const Work& work)
      : rows_(rows), overrun_(overrun) {
    std::size_t total = 0;
    for (std::size_t k = 0; k < rows; ++k) total += work(k);
    const std::size_t chunks = std::clamp<std::size_t>(rows / kRowsPerChunk, 1, kMostChunks);
    std::size_t done = 0;
    for (std::size_t k = 0; k < rows; ++k) {
      done += work(k);
      if (starts_.size() < chunks && done * chunks >= starts_.size() * total) {
        starts_.push_back(k + 1);
      }
    }
    starts_.push_back(rows);
  }

  /// Calls row(k, sums, stride) for every k: it may add to sums[p * stride + m], plane p <
  /// `planes`, what row k hands on to row k + 1 + m. Then finish(k, handed) for every k, handed[p]
  /// being the total. Calls run in parallel; all of row() come before those of finish().
  template <class Row, class Finish>
  void run(std::size_t planes, const Row& row, const Finish& finish) const {
    const std::size_t chunks = starts_.size() - 1;
    std::vector<std::vector<double>> sums(chunks);  // of chunk c: from row starts_[c] on
    parallelFor(chunks, 1, [&](std::size_t c) {
      const std::size_t stride = strideOf(c);
      sums[c].assign(stride * planes, 0.0);
      for (std::size_t k = starts_[c]; k < starts_[c + 1]; ++k) {
        row(k, sums[c].data() + (k - starts_[c]) + 1, stride);
      }
    });
    parallelFor((rows_ + kFinishBlock - 1) / kFinishBlock, 1, [&](std::size_t block) {
      std::vector<double> handed(planes);
      const std::size_t end = std::min(rows_, (block + 1) * kFinishBlock);
      for (std::size_t k = block * kFinishBlock; k < end; ++k) {
        for (std::size_t p = 0; p < planes; ++p) {
          handed[p] = 0;
          for (std::size_t c = 0; c < chunks && starts_[c] <= k; ++c) {
            handed[p] += sums[c][p * strideOf(c) + (k - starts_[c])];
          }
        }
        finish(k, handed.data());
      }
    });
  }

  /// The most that run() takes.
  static std::size_t bytes(std::size_t rows, std::size_t planes) {
    return kMostChunks * rows * planes * sizeof(double);
  }

 private:
  static constexpr std::size_t kRowsPerChunk = 128;
  static constexpr std::size_t kMostChunks = 32;
  static constexpr std::size_t kFinishBlock = 256;

  std::size_t strideOf(std::size_t chunk) const { return rows_ - starts_[chunk] + overrun_; }

  std::size_t rows_;
  std::size_t overrun_;
  std::vector<std::size_t> starts_{0};
};

}  // namespace radiosity
