// Form factors between clusters of patches, out of those between patches.
#pragma once

#include "radiosity/form_factors.h"

namespace radiosity {

/// Form factors of a mesh's patches, summed over its clusters (PatchMesh::clusters, which it has):
/// the matrix by aggregated(), the accounts as means by area. The report still describes the rows
/// that were computed, those of patches.
///
/// Error figures. Let d_ij be the error of F_ij, and |J| the patches of cluster J. The error of a
/// patch's row, summed over clusters, is by Cauchy and Schwarz at most
///
///     sqrt(sum_J (sum_j in J d_ij)^2) <= sqrt(max_J |J|) sqrt(sum_j d_ij^2),
///
/// and a cluster's row is the mean of its patches' rows by area, so that its error is at most the
/// mean of theirs: the figures of clusters are sqrt(max_J |J|) times the means of the patches'
/// figures. The matrix's follows alike (the mean of squares is no less than the square of the
/// mean), relative to the squares of the new matrix.
FormFactors clusterFactors(const FormFactors& factors, const PatchMesh& mesh, Progress& progress);

/// Bytes of the matrix between clusters, at most; `symmetric` or not.
std::size_t clusterMatrixBytes(const PatchMesh& mesh, bool symmetric, Precision precision);
/// The most bytes that clusterFactors() holds beside the patches' matrix of `patch_bytes`, its own
/// matrix included: there are no more pairs of clusters than of their patches.
std::size_t clusterFactorsBytes(const PatchMesh& mesh, bool symmetric, Precision precision,
                                std::size_t patch_bytes);

}  // namespace radiosity
