// Deals the rows of a matrix of one process out to all processes.
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

}  // namespace radiosity
