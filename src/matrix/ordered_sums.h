// Row sums of a matrix in several processes, to the bit those of one.
#pragma once

#include <vector>

#include "matrix/shared_rows.h"

namespace radiosity {

/// By all processes. Process 0 gets the sums, all others an empty vector. In the symmetric form a
/// row hands numbers on to later ones, and they are added up in chunks of rows (TrianglePass): the
/// sums of a chunk pass through the processes in the order of its rows, N numbers wherever one row
/// is another process's than the one before.
std::vector<double> orderedRowSums(Processes& processes, const ExchangeMatrix& own,
                                   const RowOwners& owners, const WhileWaiting& waiting);

}  // namespace radiosity
