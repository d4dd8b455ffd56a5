// A long dataset of an HDF5 file, written value by value.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "results/h5_writer.h"

namespace radiosity::h5 {

/// Fills a dataset of one dimension in order, a chunk at a time, so that HDF5 computes the checksum
/// of each chunk once and reads none back.
template <class T>
class ColumnWriter {
 public:
  ColumnWriter(OutputGroup& group, const char* name, std::size_t count)
      : group_(&group), name_(name) {
    const Shape shape{numberOf<T>(), count, 0};
    dataset_ = group.create(name, shape, "");
    chunk_ = chunkRows(shape);
    buffer_.reserve(std::min(chunk_, count));
  }
  void push(T value) {
    buffer_.push_back(value);
    if (buffer_.size() == chunk_) flush();
  }
  void flush() {
    if (buffer_.empty()) return;
    group_->writeRows(name_, dataset_, numberOf<T>(), written_, buffer_.size(), buffer_.data());
    written_ += buffer_.size();
    buffer_.clear();
  }

 private:
  OutputGroup* group_;
  const char* name_;
  Handle dataset_;
  std::size_t chunk_ = 0;
  std::size_t written_ = 0;
  std::vector<T> buffer_;
};

}  // namespace radiosity::h5
