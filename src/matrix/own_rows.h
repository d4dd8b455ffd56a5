// Computations of a process on its own rows of a matrix (shared_rows.h).
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "radiosity/symmetric_matrix.h"

namespace radiosity {

/// Returns the sum of row k of the triangle, its diagonal included, and adds the
/// value that it scatters to row q to scattered[q - begin]. `begin`: at most k, and a multiple of
/// kSums (triangle_kernels.h). `ones`: 1 for each row from `begin` on. Both spans have room for
/// whole vectors of rows.
double sumRow(const SymmetricMatrix& own, std::size_t k, std::size_t begin,
              std::span<const double> ones, std::span<double> scattered);

/// y = the transpose of the rows times x, N * bands. A symmetric matrix takes one product.
void transposedProduct(const ExchangeMatrix& own, std::span<const double> x, int bands,
                       std::span<double> y);

/// Calls visit(i, j, F_ij) for every entry of the rows; of a symmetric matrix also for the entries
/// that they scatter.
void forOwnEntries(const ExchangeMatrix& own,
                   const std::function<void(std::size_t, std::size_t, double)>& visit);

/// By position: the first position of the component that these rows join it to.
std::vector<Index> joinedBy(const SymmetricMatrix& own);

/// The rooms of patches in this `order`, from the first position of each component.
ExchangeOperator::Rooms roomsOf(std::span<const Index> first, std::span<const Index> order);

}  // namespace radiosity
