// A long dataset of an HDF5 file, or a part of one, written in order.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "results/h5_writer.h"

namespace radiosity::h5 {

/// Chunks first to last - 1 of a dataset.
struct ChunkRange {
  std::size_t first = 0;
  std::size_t last = 0;
};

/// Fills a dataset of one dimension in order. Checksums of chunks are computed in parallel.
template <class T>
class ColumnWriter {
 public:
  /// A whole dataset, which it makes.
  ColumnWriter(OutputGroup& group, const char* name, std::size_t count)
      : group_(&group), name_(name), shape_{numberOf<T>(), count, 0} {
    if (shape_.bytes() <= kCompactBytes) {
      buffer_.reserve(count);
      return;
    }
    made_ = group.reserve(name, shape_.number, count);
    column_ = &*made_;
    file_ = &group.chunks();
    range_ = {0, made_->places.size()};
    makeRoom();
  }
  /// Chunks of a dataset that was reserved. Its values are given from number `from` on, which is
  /// not behind the chunks' first, until the end of the chunks or later; those outside are dropped.
  ColumnWriter(const ReservedColumn& column, const ChunkFile& file, ChunkRange range,
               std::size_t from)
      : column_(&column), file_(&file), range_(range), before_(range.first * column.chunk - from) {
    makeRoom();
  }
  ColumnWriter(const ColumnWriter&) = delete;
  ColumnWriter& operator=(const ColumnWriter&) = delete;

  /// Room for the next `count` values. The caller fills it before its next call, in any order.
  std::span<T> extend(std::size_t count) {
    if (column_ != nullptr && buffer_.size() >= before_ + kChunks * column_->chunk) {
      writeChunks((buffer_.size() - before_) / column_->chunk);
    }
    buffer_.resize(buffer_.size() + count);
    return std::span(buffer_).last(count);
  }
  /// Writes what is left, after the last value.
  void flush() {
    if (column_ == nullptr) {
      group_->dataset(name_, shape_, buffer_.data(), "");
      return;
    }
    const std::size_t left = range_.last - range_.first;
    // The last chunk of a dataset is whole, too.
    buffer_.resize(std::max(buffer_.size(), before_ + left * column_->chunk));
    writeChunks(left);
  }

 private:
  static constexpr std::size_t kChunks = 4;  ///< that are written at a time

  void makeRoom() { buffer_.reserve(before_ + (kChunks + 2) * column_->chunk); }

  void writeChunks(std::size_t most) {
    const std::size_t count = std::min(most, range_.last - range_.first);
    const std::size_t chunk = column_->chunk;
    parallelFor(count, 1, [&](std::size_t c) {
      const T* values = buffer_.data() + before_ + c * chunk;
      file_->write(*column_, range_.first + c,
                   {reinterpret_cast<const unsigned char*>(values), chunk * sizeof(T)});
    });
    range_.first += count;
    buffer_.erase(buffer_.begin(), buffer_.begin() + std::ptrdiff_t(before_ + count * chunk));
    before_ = 0;
  }

  OutputGroup* group_ = nullptr;  // these three: of a whole dataset
  const char* name_ = "";
  Shape shape_;
  std::optional<ReservedColumn> made_;
  const ReservedColumn* column_ = nullptr;  // null: without chunks, and written at once
  const ChunkFile* file_ = nullptr;
  ChunkRange range_;        // the chunks to write
  std::size_t before_ = 0;  // values in the buffer that are before them
  std::vector<T> buffer_;
};

}  // namespace radiosity::h5
