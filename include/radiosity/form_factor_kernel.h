// Blocks of the form-factor matrix, computed on request.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "radiosity/base.h"
#include "radiosity/patch_mesh.h"

namespace [[gnu::visibility("default")]] radiosity {

/// F_ij for chosen rows and columns, for matrix formats that never hold all entries: hierarchical
/// ones (Hackbusch 1999), which PETSc's MATHTOOL and MATH2OPUS make from such a callback.
///
/// An entry is the mean over patch i of point-to-polygon factors at Gauss points (Lambert's
/// formula, with blocked parts clipped off exactly). Its error is the error of the rule. It falls
/// with the number of points if patch j is some way off; it falls slowly if a shadow's border
/// crosses patch i or both share an edge. So A_i F_ij = A_j F_ji holds only to that error.
/// computeFormFactors() is accurate, and faster if all entries are wanted.
class FormFactorKernel {
 public:
  static constexpr int kMostPoints = 24;

  /// `points`: along each side of a patch, 1 to kMostPoints; a patch has their square. The mesh is
  /// not needed afterwards. Errors: InputError for another number of points; Cancelled.
  FormFactorKernel(const PatchMesh& mesh, int points, Progress& progress);
  ~FormFactorKernel();
  FormFactorKernel(FormFactorKernel&&) noexcept;
  FormFactorKernel& operator=(FormFactorKernel&&) noexcept;

  std::size_t size() const;  ///< N

  /// Sets values[r * columns.size() + c] = F_ij, i = rows[r], j = columns[c]; row-major. The bits
  /// of an entry do not depend on the other rows and columns. Several threads may call it at once.
  /// Errors: InputError for a row or column of N or more and for values of another size.
  void block(std::span<const Index> rows, std::span<const Index> columns,
             std::span<double> values) const;

 private:
  struct Prepared;
  std::unique_ptr<const Prepared> prepared_;
};

}  // namespace radiosity
