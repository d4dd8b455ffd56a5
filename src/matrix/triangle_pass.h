// A pass over the triangle, by many threads, in which every row hands values on to later rows.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/aligned_buffer.h"
#include "base/parallel.h"

namespace radiosity {

/// Rows of different threads hand values on to the same places. So rows are divided into chunks of
/// about equal work, each with sums of its own, which are added up in order. The chunks depend on
/// the work alone, so any number of threads gives the same bits.
class TrianglePass {
 public:
  /// `work(k)`: the work of row k, in any unit. Chunks start at multiples of `lanes`, and sums have
  /// room for whole lanes after the last row.
  template <class Work>
  TrianglePass(std::size_t rows, std::size_t lanes, const Work& work) : rows_(rows), lanes_(lanes) {
    std::size_t total = 0;
    for (std::size_t k = 0; k < rows; ++k) total += work(k);
    const std::size_t chunks = std::clamp<std::size_t>(rows / kRowsPerChunk, 1, kMostChunks);
    std::size_t done = 0;
    for (std::size_t k = 0; k < rows; ++k) {
      done += work(k);
      if (starts_.size() < chunks && done * chunks >= starts_.size() * total &&
          (k + 1) % lanes == 0) {
        starts_.push_back(k + 1);
      }
    }
    starts_.push_back(rows);
  }

  /// Calls rows(first, last, sums, stride) for ranges that together are all rows. It may add the
  /// values for a later row q in plane p < `planes` to sums[p * stride + q - first]. Then calls
  /// finish(k, handed) for every k; handed[p] is the total. Calls run in parallel; all of rows()
  /// come before those of finish(). `first` and `stride` are multiples of the lanes; sums are
  /// aligned to a cache line.
  template <class Rows, class Finish>
  void runRanges(std::size_t planes, const Rows& rows, const Finish& finish) const {
    const std::size_t chunks = starts_.size() - 1;
    std::vector<AlignedBuffer<double>> sums(chunks);  // sums[c]: from row starts_[c] on
    parallelFor(chunks, 1, [&](std::size_t c) {
      const std::size_t stride = strideOf(c);
      sums[c].reserve(stride * planes);
      std::fill_n(sums[c].data(), stride * planes, 0.0);
      rows(starts_[c], starts_[c + 1], sums[c].data(), stride);
    });
    parallelFor((rows_ + kFinishBlock - 1) / kFinishBlock, 1, [&](std::size_t block) {
      const std::size_t begin = block * kFinishBlock;
      const std::size_t end = std::min(rows_, begin + kFinishBlock);
      const std::vector<double> totals = totalsOf(sums, planes, begin, end);
      std::vector<double> handed(planes);
      for (std::size_t k = begin; k < end; ++k) {
        for (std::size_t p = 0; p < planes; ++p) handed[p] = totals[p * (end - begin) + k - begin];
        finish(k, handed.data());
      }
    });
  }

  /// The same row by row. Calls row(k, sums, stride) for every k; it may add the value for row
  /// k + 1 + m to sums[p * stride + m].
  template <class Row, class Finish>
  void run(std::size_t planes, const Row& row, const Finish& finish) const {
    const auto rows = [&](std::size_t first, std::size_t last, double* sums, std::size_t stride) {
      for (std::size_t k = first; k < last; ++k) row(k, sums + (k - first) + 1, stride);
    };
    runRanges(planes, rows, finish);
  }

  /// The first row of each chunk, and the end.
  const std::vector<std::size_t>& starts() const { return starts_; }

  /// The most bytes that run() takes.
  static std::size_t bytes(std::size_t rows, std::size_t planes) {
    return kMostChunks * rows * planes * sizeof(double);
  }

 private:
  static constexpr std::size_t kRowsPerChunk = 128;
  static constexpr std::size_t kMostChunks = 32;
  static constexpr std::size_t kFinishBlock = 256;

  std::size_t strideOf(std::size_t chunk) const {
    return (rows_ - starts_[chunk] + lanes_ - 1) / lanes_ * lanes_;
  }

  /// What all chunks scatter to rows [begin, end), plane by plane; it is added chunk by chunk, so
  /// that memory is read in order.
  std::vector<double> totalsOf(const std::vector<AlignedBuffer<double>>& sums, std::size_t planes,
                               std::size_t begin, std::size_t end) const {
    std::vector<double> totals(planes * (end - begin), 0.0);
    for (std::size_t c = 0; c < sums.size() && starts_[c] < end; ++c) {
      const std::size_t first = std::max(begin, starts_[c]);
      for (std::size_t p = 0; p < planes; ++p) {
        const double* from = sums[c].data() + p * strideOf(c) + (first - starts_[c]);
        double* to = totals.data() + p * (end - begin) + (first - begin);
        for (std::size_t k = 0; k < end - first; ++k) to[k] += from[k];
      }
    }
    return totals;
  }

  std::size_t rows_;
  std::size_t lanes_;
  std::vector<std::size_t> starts_{0};
};

}  // namespace radiosity
