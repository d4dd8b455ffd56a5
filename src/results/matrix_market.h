// Writes MatrixMarket with comments on rows, for data that the format has no place for.
#pragma once

#include <functional>
#include <string>

#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// The text of the comment on row i, without the leading "% ".
using CommentOfRow = std::function<std::string(std::size_t i)>;

/// writeMatrixMarket() of results.h, with a comment line for each row; `comment` empty: none.
void writeMatrixMarket(const std::string& path, const ExchangeMatrix& matrix,
                       const CommentOfRow& comment, Progress& progress);

}  // namespace radiosity
