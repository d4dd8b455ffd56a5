// Computations of a process on its own rows of a matrix (shared_rows.h).
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// Symmetric form: returns the sum of row k of the triangle, its diagonal included, and adds the
/// value that it scatters to row q to scattered[q - begin]. `begin`: at most k, and a multiple of
/// kSums (triangle_kernels.h). `ones`: 1 for each row from `begin` on. Both spans have room for
/// whole vectors of rows.
double sumRow(const ExchangeMatrix& own, std::size_t k, std::size_t begin,
              std::span<const double> ones, std::span<double> scattered);

/// y = the transpose of the rows times x, N * bands. The symmetric form takes one product.
void transposedProduct(const ExchangeMatrix& own, std::span<const double> x, int bands,
                       std::span<double> y);

/// Calls visit(i, j, F_ij) for every entry of the rows; in the symmetric form also for the entries
/// that they scatter.
void forOwnEntries(const ExchangeMatrix& own,
                   const std::function<void(std::size_t, std::size_t, double)>& visit);

/// Symmetric form, by position: the first position of the component that these rows join it to.
std::vector<Index> joinedBy(const ExchangeMatrix& own);

}  // namespace radiosity
