// Form factors in 16 bits each, one for each pair.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/exchange_matrix.h"
#include "radiosity/page.h"

namespace radiosity::page {

/// F_ij of all pairs i <= j, row by row; F_ji = F_ij A_i / A_j. Logarithms are rounded to 65,535
/// equal steps, so that every form factor has the same relative error.
struct FactorCodes {
  std::vector<std::uint32_t> begin;   ///< K + 1, into the others
  std::vector<std::uint32_t> column;  ///< increasing in a row; empty: rows hold every j >= i
  std::vector<std::uint16_t> code;    ///< 0: F_ij = 0
  FactorQuantisation quantisation;
  std::size_t pairs = 0;  ///< codes that are not 0

  static constexpr std::uint32_t kLargestCode = 65535;
};

/// The codes of a symmetric matrix (ExchangeOperator::isSymmetric()) of at most kMostPageNodes
/// rows. Rows are dense if more than half of all pairs are kept. Throws Cancelled.
FactorCodes encodeFactors(const ExchangeMatrix& matrix, Progress& progress);

}  // namespace radiosity::page
