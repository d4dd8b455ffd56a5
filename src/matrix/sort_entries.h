// The entries of a row put in order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// Sorts the entries of rows by column. One for each thread.
class EntrySorter {
 public:
  /// `columns`: different ones below `n`; `values`: one each.
  void sort(std::span<Index> columns, std::span<double> values, std::size_t n) {
    if (std::is_sorted(columns.begin(), columns.end())) return;
    if (columns.size() > n / kSparse) {
      layOut(columns, values, n);
    } else {
      sortPairs(columns, values);
    }
  }

 private:
  /// A row with more than one entry in so many columns is sorted by laying it out.
  static constexpr std::size_t kSparse = 32;

  void layOut(std::span<Index> columns, std::span<double> values, std::size_t n) {
    place_.assign(n, kNone);
    for (std::size_t m = 0; m < columns.size(); ++m) place_[columns[m]] = Index(m);
    unsorted_.assign(values.begin(), values.end());
    std::size_t next = 0;
    for (std::size_t column = 0; column < n; ++column) {
      if (place_[column] == kNone) continue;
      columns[next] = Index(column);
      values[next++] = unsorted_[place_[column]];
    }
  }

  void sortPairs(std::span<Index> columns, std::span<double> values) {
    pairs_.clear();
    for (std::size_t m = 0; m < columns.size(); ++m) pairs_.emplace_back(columns[m], values[m]);
    std::sort(pairs_.begin(), pairs_.end());
    for (std::size_t m = 0; m < columns.size(); ++m) std::tie(columns[m], values[m]) = pairs_[m];
  }

  std::vector<Index> place_;
  std::vector<double> unsorted_;
  std::vector<std::pair<Index, double>> pairs_;
};

}  // namespace radiosity
