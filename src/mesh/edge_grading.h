// Where one edge is cut.
#pragma once

#include <array>
#include <limits>
#include <vector>

namespace radiosity {

enum class Rounding { at_most, nearest };

/// How an edge is to be cut, in the direction of its class. Sizes grow from its ends into it.
struct EdgeSize {
  double size = 0;                                         ///< of pieces; at_most: none is longer
  double start = std::numeric_limits<double>::infinity();  ///< wanted at its start
  double end = std::numeric_limits<double>::infinity();    ///< and at its end
  double most_pieces = std::numeric_limits<double>::infinity();
  /// Cut here in any case: parts of the length, rising. With stops `start` and `end` say nothing.
  std::vector<double> stops = {};
};

/// How many pieces an edge of `length` gets; a whole number, 1 or more (it may be huge).
double pieceCount(double length, const EdgeSize& wanted, Rounding rounding);

/// The lengths of the first and the last of `count` pieces; of graded edges, the mean.
std::array<double, 2> endPieces(double length, const EdgeSize& wanted, double count,
                                Rounding rounding);

/// Where the `count` pieces meet: count - 1 numbers between 0 and 1, rising. The parts between
/// stops are cut evenly, each on its own, so that equal parts of two edges are cut alike. Without
/// wanted sizes at the ends the pieces are equal. With them the size at distance t from the start
/// is s(t) = min(size, start + g t, end + g (length - t)), and cuts are where the integral of 1/s
/// passes whole parts of its total; neighbouring pieces then differ by at most e^g = 2.
std::vector<double> cutFractions(double length, const EdgeSize& wanted, double count,
                                 Rounding rounding);

}  // namespace radiosity
