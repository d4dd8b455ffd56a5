// MatrixMarket out, with more to say of each row than the format has a place for.
#pragma once

#include <functional>
#include <string>

#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// What a comment says of row i, without the leading "% ".
using CommentOfRow = std::function<std::string(std::size_t i)>;

/// writeMatrixMarket() of results.h, with a comment line a row; `comment` empty: none.
void writeMatrixMarket(const std::string& path, const ExchangeMatrix& matrix,
                       const CommentOfRow& comment, Progress& progress);

}  // namespace radiosity
