// Where one edge is cut.
#pragma once

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
};

/// How many pieces an edge of `length` gets; a whole number, 1 or more (it may be huge).
double pieceCount(double length, const EdgeSize& wanted, Rounding rounding);

/// Where the `count` pieces meet: count - 1 numbers between 0 and 1, rising. Without wanted sizes
/// at the ends the pieces are equal. With them the size at distance t from the start is
/// s(t) = min(size, start + g t, end + g (length - t)), and cuts are where the integral of 1/s
/// passes whole parts of its total; neighbouring pieces then differ by at most e^g = 2.
std::vector<double> cutFractions(double length, const EdgeSize& wanted, double count);

}  // namespace radiosity
