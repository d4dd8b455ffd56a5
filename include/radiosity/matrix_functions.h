// Functions of whole matrices: norms, reciprocity, sizes.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "radiosity/row_matrix.h"
#include "radiosity/symmetric_matrix.h"

namespace [[gnu::visibility("default")]] radiosity {

/// sum_ij A_i F_ij^2, m^2: errors in the area-weighted L2 norm are relative to its root.
double weightedSquares(const ExchangeMatrix& matrix);

/// sqrt(sum_ij (G_ij - G_ji)^2 / sum_ij G_ij^2): how far the two estimates of each pair differ.
/// It detects errors, it does not bound them. 0 for an empty matrix.
double reciprocityResidual(const ExchangeMatrix& matrix);

/// Merges the two estimates of every pair, G_ij = w_i A_i F_ij + w_j A_j F_ji with
/// w_i = A_j^2 / (A_i^2 + A_j^2) (the bias of the estimate made at i goes as A_i / d^2). The result
/// has patches in their own order and other row sums: call closeRows() (closure.h) before solving
/// in a closed scene.
SymmetricMatrix symmetrized(const RowMatrix& matrix);

/// The matrix between groups of patches: G_IJ = sum of A_i F_ij over i in I and j in J, and
/// F_IJ = G_IJ / A_I, with A_I the area of group I; F_II is the form factor of a group to itself.
/// Row sums, weighted by area, and reciprocity are kept. What is symmetric gives a SymmetricMatrix,
/// all else a RowMatrix, with the precision `stored`, else that of the pairs stored in this
/// process, else double. `group_of`: N groups below `groups`, else InputError. Throws Cancelled.
std::shared_ptr<const ExchangeMatrix> aggregated(const ExchangeOperator& factors,
                                                 std::span<const Index> group_of,
                                                 std::size_t groups, Progress& progress,
                                                 std::optional<Precision> stored = {});

/// Bytes that N rows with `entries_per_row` entries take in row form.
std::size_t estimateRowFormBytes(std::size_t n, double entries_per_row, Precision precision);
/// The most bytes that a symmetric matrix with that many entries per row takes, in any arrangement.
std::size_t estimateSymmetricBytes(std::size_t n, double entries_per_row, Precision precision);

}  // namespace radiosity
