// Row sums of a matrix in several processes, with the same bits as in one process.
#pragma once

#include <vector>

#include "matrix/shared_rows.h"

namespace radiosity {

/// All processes call this. Process 0 gets the sums, all others an empty vector. In a symmetric
/// matrix a row hands numbers on to later rows, and chunks of rows add them up (TrianglePass). The
/// sums of a chunk pass through the processes in the order of its rows: N numbers wherever a row is
/// in another process than the row before. Processes, and threads, work on different chunks at the
/// same time.
std::vector<double> orderedRowSums(Processes& processes, const ExchangeMatrix& own,
                                   const RowOwners& owners, const WhileWaiting& waiting);

}  // namespace radiosity
