// Deals the rows of a matrix out to processes.
#pragma once

#include "base/processes.h"
#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// Process 0 calls this while the others call receiveRows(). `whole`: in the symmetric form.
/// Returns the rows that stay, a share of about equal work; all others are empty. Values keep their
/// bits.
ExchangeMatrix dealRows(Processes& processes, const ExchangeMatrix& whole,
                        const WhileWaiting& waiting);

/// The other processes call this. Returns their share.
ExchangeMatrix receiveRows(Processes& processes);

/// Called by all processes, for rows in the symmetric form that they made themselves. Those that
/// have more than their share of the work of a product send rows to those that have less.
void evenOut(Processes& processes, ExchangeMatrix& own, const WhileWaiting& waiting);

}  // namespace radiosity
