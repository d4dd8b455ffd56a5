#include "solve/krylov.h"

#include <Eigen/QR>

namespace radiosity {

namespace {

/// A new direction is rounding if its part orthogonal to the others is below this share.
constexpr double kRounding = 1e-13;

}  // namespace

Krylov::Krylov(const Eigen::VectorXd& step) : norm_(step.norm()) {
  exhausted_ = !(norm_ > 0);
  basis_.push_back(exhausted_ ? Eigen::VectorXd(Eigen::VectorXd::Zero(step.size()))
                              : Eigen::VectorXd(step / norm_));
}

void Krylov::add(const Eigen::VectorXd& image) {
  if (exhausted_) return;
  Eigen::VectorXd fresh = basis_.back() - image;
  Eigen::VectorXd column = Eigen::VectorXd::Zero(Eigen::Index(basis_.size()) + 1);
  const double before = fresh.norm();
  // Twice is enough to stay orthogonal (Giraud, Langou & Rozloznik 2005).
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t j = 0; j < basis_.size(); ++j) {
      const double along = basis_[j].dot(fresh);
      column[Eigen::Index(j)] += along;
      fresh -= along * basis_[j];
    }
  }
  const double left = fresh.norm();
  exhausted_ = !(left > kRounding * before);
  if (!exhausted_) column[column.size() - 1] = left;
  columns_.push_back(column);
  basis_.push_back(exhausted_ ? Eigen::VectorXd(Eigen::VectorXd::Zero(fresh.size()))
                              : Eigen::VectorXd(fresh / left));
}

Eigen::VectorXd Krylov::leastSquares() const {
  const auto k = Eigen::Index(columns_.size());
  Eigen::MatrixXd hessenberg = Eigen::MatrixXd::Zero(k + 1, k);
  for (Eigen::Index j = 0; j < k; ++j) {
    hessenberg.col(j).head(j + 2) = columns_[std::size_t(j)];
  }
  Eigen::VectorXd target = Eigen::VectorXd::Zero(k + 1);
  target[0] = norm_;
  return hessenberg.colPivHouseholderQr().solve(target);
}

Eigen::VectorXd Krylov::residual() const {
  if (columns_.empty()) return norm_ * basis_.front();
  const Eigen::VectorXd weights = leastSquares();
  Eigen::VectorXd along = Eigen::VectorXd::Zero(Eigen::Index(basis_.size()));  // of what is left
  along[0] = norm_;
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    along.head(columns_[k].size()) -= weights[Eigen::Index(k)] * columns_[k];
  }
  Eigen::VectorXd left = Eigen::VectorXd::Zero(basis_.front().size());
  for (std::size_t j = 0; j < basis_.size(); ++j) left += along[Eigen::Index(j)] * basis_[j];
  return left;
}

Eigen::VectorXd Krylov::correction() const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(basis_.front().size());
  if (columns_.empty()) return sum;
  const Eigen::VectorXd weights = leastSquares();
  for (std::size_t k = 0; k < columns_.size(); ++k) sum += weights[Eigen::Index(k)] * basis_[k];
  return sum;
}

}  // namespace radiosity
