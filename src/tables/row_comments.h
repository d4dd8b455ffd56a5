// The comments on rows in a MatrixMarket file of ours.
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

/// "row I area A sky S backs B name NAME" for row i, from 0; not longer than a line of the format.
std::string rowComment(const NamedFactors& factors, std::size_t i);
/// Parses such a comment; empty for other comments.
std::optional<RowComment> parseRowComment(std::string_view text);

}  // namespace radiosity
