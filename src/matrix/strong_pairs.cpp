#include "matrix/strong_pairs.h"

namespace radiosity {
namespace {

/// Added to the diagonal: two rows that are coupled only to each other are singular.
constexpr double kHeld = 1e-4;

}  // namespace

StrongPairs::StrongPairs(std::span<const double> diagonal, std::span<const Pair> pairs) {
  const auto n = Eigen::Index(diagonal.size());
  std::vector<Eigen::Triplet<double>> values;
  values.reserve(diagonal.size() + pairs.size());
  for (Eigen::Index k = 0; k < n; ++k) {
    values.emplace_back(k, k, diagonal[std::size_t(k)] + kHeld);
  }
  for (const Pair& pair : pairs) {
    values.emplace_back(Eigen::Index(pair.later), Eigen::Index(pair.row), pair.value);
  }
  Matrix matrix(n, n);
  matrix.setFromTriplets(values.begin(), values.end());
  solver_.compute(matrix);
}

std::vector<double> StrongPairs::solve(const std::vector<double>& x) const {
  const Eigen::VectorXd y =
      solver_.solve(Eigen::Map<const Eigen::VectorXd>(x.data(), Eigen::Index(x.size())));
  return {y.data(), y.data() + y.size()};
}

}  // namespace radiosity
