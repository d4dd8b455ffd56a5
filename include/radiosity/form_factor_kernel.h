// Blocks of the form-factor matrix, made when they are asked for.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "radiosity/base.h"
#include "radiosity/patch_mesh.h"

namespace [[gnu::visibility("default")]] radiosity {

/// F_ij for chosen rows and columns, for matrix formats that never hold all entries: hierarchical
/// ones (Hackbusch 1999), as PETSc's MATHTOOL and MATH2OPUS make them from such a callback.
///
/// An entry is the mean over patch i of point-to-polygon factors (Lambert's formula, with what is
/// in between clipped off exactly) at Gauss points. Its error is that of the rule: it falls with
/// the points where patch j is some way off, slowly where a shadow's border crosses patch i or both
/// share an edge. So A_i F_ij = A_j F_ji holds to that error alone. computeFormFactors() is
/// accurate, and faster where all entries are wanted.
class FormFactorKernel {
 public:
  static constexpr int kMostPoints = 24;

  /// `points`: along each side of a patch, 1 to kMostPoints, the square of them a patch. The mesh
  /// is not needed afterwards. Errors: InputError for another number of points; Cancelled.
  FormFactorKernel(const PatchMesh& mesh, int points, Progress& progress);
  ~FormFactorKernel();
  FormFactorKernel(FormFactorKernel&&) noexcept;
  FormFactorKernel& operator=(FormFactorKernel&&) noexcept;

  std::size_t size() const;  ///< N

  /// values[r * columns.size() + c] = F_ij, i = rows[r], j = columns[c]; row-major. The same bits
  /// whatever else is asked for. Several threads may call it at once. Errors: InputError for a row
  /// or column that is N or more, and where values is of another size.
  void block(std::span<const Index> rows, std::span<const Index> columns,
             std::span<double> values) const;

 private:
  struct Prepared;
  std::unique_ptr<const Prepared> prepared_;
};

}  // namespace radiosity
