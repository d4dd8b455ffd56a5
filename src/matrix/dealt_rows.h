// Deals the rows of a matrix out to processes.
#pragma once

#include <memory>

#include "base/processes.h"
#include "radiosity/symmetric_matrix.h"

namespace radiosity {

/// Process 0 calls this while the others call receiveRows(). Returns the rows that stay, a share of
/// about equal work; all others are empty. Values keep their bits.
std::shared_ptr<const SymmetricMatrix> dealRows(Processes& processes, const SymmetricMatrix& whole,
                                                const WhileWaiting& waiting);

/// The other processes call this. Returns their share.
std::shared_ptr<const SymmetricMatrix> receiveRows(Processes& processes);

/// Called by all processes, for rows that they made themselves. Those that
/// have more than their share of the work of a product send rows to those that have less.
void evenOut(Processes& processes, SymmetricMatrix& own, const WhileWaiting& waiting);

}  // namespace radiosity
