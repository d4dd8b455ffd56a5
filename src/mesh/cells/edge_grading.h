// The cuts of one edge.
#pragma once

#include <array>
#include <limits>
#include <vector>

namespace radiosity {

enum class Rounding { at_most, nearest };

/// The wanted sizes of the pieces of an edge, in the direction of its class. Sizes grow from both
/// ends inwards.
struct EdgeSize {
  double size = 0;                                         ///< of pieces; at_most: none is longer
  double start = std::numeric_limits<double>::infinity();  ///< wanted at its start
  double end = std::numeric_limits<double>::infinity();    ///< and at its end
  double most_pieces = std::numeric_limits<double>::infinity();
  /// Places of obligatory cuts: shares of the length, ascending. With stops, `start` and `end` are
  /// ignored.
  std::vector<double> stops = {};
};

/// The number of pieces of an edge of `length`; an integer, 1 or more (it may be huge).
double pieceCount(double length, const EdgeSize& wanted, Rounding rounding);

/// The lengths of the first and the last of `count` pieces; for graded edges, the mean.
std::array<double, 2> endPieces(double length, const EdgeSize& wanted, double count,
                                Rounding rounding);

/// The places where `count` pieces meet: count - 1 numbers between 0 and 1, ascending. Each part
/// between stops is cut evenly on its own, so that equal parts of two edges are cut alike. Without
/// wanted sizes at the ends the pieces are equal. With them the size at distance t from the start
/// is s(t) = min(size, start + g t, end + g (length - t)), and the cuts divide the integral of 1/s
/// into equal parts; neighbouring pieces then differ by at most a factor of e^g = 2.
std::vector<double> cutFractions(double length, const EdgeSize& wanted, double count,
                                 Rounding rounding);

}  // namespace radiosity
