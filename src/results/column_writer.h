// A long dataset of an HDF5 file, written in order.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "results/h5_writer.h"

namespace radiosity::h5 {

/// Fills a dataset of one dimension in order. Checksums of chunks are computed in parallel, and
/// HDF5 takes the chunks as they are.
template <class T>
class ColumnWriter {
 public:
  ColumnWriter(OutputGroup& group, const char* name, std::size_t count)
      : group_(&group), name_(name), shape_{numberOf<T>(), count, 0}, chunk_(chunkRows(shape_)) {
    if (shape_.bytes() > kCompactBytes) dataset_ = group.create(name, shape_, "");
    buffer_.reserve(std::min((kChunks + 2) * chunk_, count + chunk_));
  }
  /// Room for the next `count` values. The caller fills it before its next call, in any order.
  std::span<T> extend(std::size_t count) {
    if (buffer_.size() >= kChunks * chunk_) writeChunks(buffer_.size() / chunk_);
    buffer_.resize(buffer_.size() + count);
    return std::span(buffer_).last(count);
  }
  /// Writes what is left, after the last value.
  void flush() {
    if (!dataset_) {
      group_->dataset(name_, shape_, buffer_.data(), "");
      return;
    }
    if (buffer_.empty()) return;
    buffer_.resize((buffer_.size() + chunk_ - 1) / chunk_ * chunk_);  // the last one is whole, too
    writeChunks(buffer_.size() / chunk_);
  }

 private:
  static constexpr std::size_t kChunks = 4;  ///< that are written at a time

  void writeChunks(std::size_t count) {
    std::vector<std::vector<unsigned char>> stored(count);
    parallelFor(count, 1, [&](std::size_t c) {
      const auto* bytes = reinterpret_cast<const unsigned char*>(buffer_.data() + c * chunk_);
      stored[c] = storedChunk({bytes, chunk_ * sizeof(T)});
    });
    for (const std::vector<unsigned char>& bytes : stored) {
      group_->writeChunk(name_, dataset_, written_, bytes);
      written_ += chunk_;
    }
    buffer_.erase(buffer_.begin(), buffer_.begin() + std::ptrdiff_t(count * chunk_));
  }

  OutputGroup* group_;
  const char* name_;
  Shape shape_;
  Handle dataset_;  // none: without chunks, and written at once
  std::size_t chunk_;
  std::size_t written_ = 0;
  std::vector<T> buffer_;
};

}  // namespace radiosity::h5
