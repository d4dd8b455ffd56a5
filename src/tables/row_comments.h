// What a MatrixMarket file of ours says of its rows, in comments.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "radiosity/tables.h"

namespace radiosity {

struct RowComment {
  std::size_t row = 0;  ///< from 0
  double area = 0;
  double sky = 0;
  double backs = 0;
  std::string name;
};

/// "row I area A sky S backs B name NAME" of row i, from 0; at most a line of the format.
std::string rowComment(const NamedFactors& factors, std::size_t i);
/// The same read; nothing for other comments.
std::optional<RowComment> parseRowComment(std::string_view text);

}  // namespace radiosity
