// Rows that see no sky, alike for every method.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "radiosity/form_factors.h"

namespace radiosity {

/// Rows of patches that are enclosed (Enclosures::enclosed): they see fronts and backs alone. If a
/// method nevertheless misses much of a row, the row is open.
class ClosedRows {
 public:
  explicit ClosedRows(const PatchMesh& mesh);

  bool closed(std::size_t row) const { return state_[row] == kClosed; }
  bool any() const;

  /// Of the view of a closed row rays, or pixels, may miss this share, between faces that meet but
  /// for rounding.
  static constexpr double kMostLeaks = 1e-3;

  /// Whether a row is closed of which the method misses the share `missing`, which should be `most`
  /// at most: else it is open from now on. Thread-safe for different rows.
  bool keeps(std::size_t row, double missing, double most) {
    if (closed(row) && missing > most) state_[row] = kRefuted;
    return closed(row);
  }
  /// Sets the sky to the rest of each open row that is not empty. What a closed one misses, or any
  /// has beyond 1, is its error: FormFactorReport::largest_row_error is that at least.
  void balance(FormFactors& result) const;
  /// Sets FormFactorReport::closed, and warns of rows that keeps() has opened.
  void report(const PatchMesh& mesh, FormFactorReport& report) const;

 private:
  static constexpr std::uint8_t kOpen = 0;
  static constexpr std::uint8_t kClosed = 1;
  static constexpr std::uint8_t kRefuted = 2;

  std::vector<std::uint8_t> state_;
};

}  // namespace radiosity
