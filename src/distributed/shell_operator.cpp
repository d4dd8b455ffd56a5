#include "distributed/shell_operator.h"

#include <fmt/format.h>
#include <petscvec.h>

#include <algorithm>
#include <cmath>

#include "radiosity/base.h"

namespace radiosity {

namespace {

/// Reads and writes the values of a vector that this process owns.
class VecValues {
 public:
  explicit VecValues(Vec vector) : vector_(vector) {
    requireNoError(VecGetArray(vector, &values_));
  }
  ~VecValues() { VecRestoreArray(vector_, &values_); }
  VecValues(const VecValues&) = delete;
  VecValues& operator=(const VecValues&) = delete;
  double& operator[](std::size_t k) { return values_[k]; }
  double* data() { return values_; }

 private:
  Vec vector_;
  double* values_ = nullptr;
};

class ConstVecValues {
 public:
  explicit ConstVecValues(Vec vector) : vector_(vector) {
    requireNoError(VecGetArrayRead(vector, &values_));
  }
  ~ConstVecValues() { VecRestoreArrayRead(vector_, &values_); }
  ConstVecValues(const ConstVecValues&) = delete;
  ConstVecValues& operator=(const ConstVecValues&) = delete;
  double operator[](std::size_t k) const { return values_[k]; }
  const double* data() const { return values_; }

 private:
  Vec vector_;
  const double* values_ = nullptr;
};

}  // namespace

void requireNoError(PetscErrorCode code) {
  if (code == 0) return;
  const char* text = nullptr;
  PetscErrorMessage(code, &text, nullptr);
  throw RunError(fmt::format("PETSc failed ({}): {}", int(code),
                             text != nullptr ? text : "no further words; see its options"));
}

ShellOperator::ShellOperator(const KrylovProblem& problem)
    : problem_(problem),
      x_(problem.rows * std::size_t(problem.bands)),
      y_(problem.rows * std::size_t(problem.bands)) {
  int size = 1;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank_);
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  for (int p = 0; p < size; ++p) {
    const auto begin = problem.rows * std::size_t(p) / std::size_t(size);
    const auto end = problem.rows * std::size_t(p + 1) / std::size_t(size);
    starts_.push_back(int(begin) * problem.bands);
    counts_.push_back(int(end - begin) * problem.bands);
  }
  const auto own = PetscInt(count());
  requireNoError(MatCreateShell(PETSC_COMM_WORLD, own, own, PetscInt(x_.size()),
                                PetscInt(x_.size()), this, &matrix_));
  const auto set = [&](MatOperation operation, auto* function) {
    requireNoError(
        MatShellSetOperation(matrix_, operation, reinterpret_cast<void (*)()>(function)));
  };
  set(MATOP_MULT, &ShellOperator::multiply);
  set(MATOP_MULT_TRANSPOSE, &ShellOperator::multiplyTransposed);
  set(MATOP_GET_DIAGONAL, &ShellOperator::diagonal);
  if (problem.symmetric) requireNoError(MatSetOption(matrix_, MAT_SYMMETRIC, PETSC_TRUE));
}

ShellOperator::~ShellOperator() { MatDestroy(&matrix_); }

PetscErrorCode ShellOperator::multiply(Mat matrix, Vec x, Vec y) {
  ShellOperator* shell = nullptr;
  MatShellGetContext(matrix, &shell);
  shell->apply(x, y, false);
  return 0;
}

PetscErrorCode ShellOperator::multiplyTransposed(Mat matrix, Vec x, Vec y) {
  ShellOperator* shell = nullptr;
  MatShellGetContext(matrix, &shell);
  shell->apply(x, y, true);
  return 0;
}

/// y = x - L F R x, or x - R F^T L x.
void ShellOperator::apply(Vec x, Vec y, bool transposed) {
  const std::span<const double> before = own(transposed ? problem_.left : problem_.right);
  const std::span<const double> after = own(transposed ? problem_.right : problem_.left);
  const ConstVecValues from(x);
  std::vector<double> scaled(count());
  for (std::size_t k = 0; k < scaled.size(); ++k) scaled[k] = before[k] * from[k];
  MPI_Allgatherv(scaled.data(), int(scaled.size()), MPI_DOUBLE, x_.data(), counts_.data(),
                 starts_.data(), MPI_DOUBLE, PETSC_COMM_WORLD);
  (transposed ? problem_.transposed_product : problem_.product)(x_, y_);
  const std::vector<double> sums = sharedSums(y_);
  VecValues to(y);
  for (std::size_t k = 0; k < sums.size(); ++k) to[k] = from[k] - after[k] * sums[k];
}

/// This process's range of the sums over all processes.
std::vector<double> ShellOperator::sharedSums(std::vector<double>& parts) const {
  std::vector<double> sums(count());
  MPI_Reduce_scatter(parts.data(), sums.data(), counts_.data(), MPI_DOUBLE, MPI_SUM,
                     PETSC_COMM_WORLD);
  return sums;
}

PetscErrorCode ShellOperator::diagonal(Mat matrix, Vec diagonal) {
  ShellOperator* shell = nullptr;
  MatShellGetContext(matrix, &shell);
  const KrylovProblem& problem = shell->problem_;
  const auto bands = std::size_t(problem.bands);
  std::vector<double> parts(problem.rows * bands, 0.0);
  problem.entries([&](std::size_t i, std::size_t j, double value) {
    if (i != j) return;
    for (std::size_t k = i * bands; k < (i + 1) * bands; ++k) {
      parts[k] += problem.left[k] * value * problem.right[k];
    }
  });
  const std::vector<double> sums = shell->sharedSums(parts);
  VecValues to(diagonal);
  for (std::size_t k = 0; k < sums.size(); ++k) to[k] = 1 - sums[k];
  return 0;
}

void ShellOperator::gather(Vec vector, std::span<double> all) const {
  const ConstVecValues values(vector);
  MPI_Gatherv(values.data(), int(count()), MPI_DOUBLE, all.data(), counts_.data(), starts_.data(),
              MPI_DOUBLE, 0, PETSC_COMM_WORLD);
}

Mat ShellOperator::assembled() const {
  const auto bands = std::size_t(problem_.bands);
  std::vector<double> entries(x_.size(), 1.0 / double(counts_.size()));  // sums to the 1 of I
  problem_.entries([&](std::size_t i, std::size_t /*j*/, double /*value*/) {
    for (std::size_t b = 0; b < bands; ++b) entries[i * bands + b] += 1;
  });
  std::vector<PetscInt> here;
  std::vector<PetscInt> elsewhere;
  for (const double sum : sharedSums(entries)) {
    const auto most = PetscInt(std::lround(sum));
    here.push_back(std::min(most, PetscInt(count())));
    elsewhere.push_back(std::min(most, PetscInt(x_.size() - count())));
  }
  Mat matrix = nullptr;
  const auto all = PetscInt(x_.size());
  requireNoError(MatCreateAIJ(PETSC_COMM_WORLD, PetscInt(count()), PetscInt(count()), all, all, 0,
                              here.data(), 0, elsewhere.data(), &matrix));
  const auto add = [&](std::size_t i, std::size_t j, double value) {
    const auto row = PetscInt(i);
    const auto column = PetscInt(j);
    requireNoError(MatSetValues(matrix, 1, &row, 1, &column, &value, ADD_VALUES));
  };
  problem_.entries([&](std::size_t i, std::size_t j, double value) {
    for (std::size_t b = 0; b < bands; ++b) {
      const std::size_t row = i * bands + b;
      const std::size_t column = j * bands + b;
      add(row, column, -problem_.left[row] * value * problem_.right[column]);
    }
  });
  for (std::size_t k = first(); k < first() + count(); ++k) add(k, k, 1);
  requireNoError(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  requireNoError(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  if (problem_.symmetric) requireNoError(MatSetOption(matrix, MAT_SYMMETRIC, PETSC_TRUE));
  return matrix;
}

}  // namespace radiosity
