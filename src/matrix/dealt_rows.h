// A matrix that one process made, its rows dealt out to all of them.
#pragma once

#include "base/processes.h"
#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// By process 0, while the others call receiveRows(). `whole`: in the symmetric form. Returns the
/// rows that stay, a share of about equal work; all others are empty. Values keep their bits.
ExchangeMatrix dealRows(Processes& processes, const ExchangeMatrix& whole,
                        const WhileWaiting& waiting);

/// By the others: their share.
ExchangeMatrix receiveRows(Processes& processes);

}  // namespace radiosity
