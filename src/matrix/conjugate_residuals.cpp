#include "matrix/conjugate_residuals.h"

#include <cstddef>
#include <numeric>
#include <utility>

namespace radiosity {

namespace {

constexpr std::size_t kMostSteps = 2000;
/// A residual r counts as a null vector if <r, A r> is below this share of its square.
constexpr double kNull = 1e-10;
/// The residual must halve within this number of steps; otherwise the right side is out of reach.
constexpr std::size_t kStagnantSteps = 50;

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

}  // namespace

std::vector<double> conjugateResiduals(const ResidualSystem& system, std::vector<double> right,
                                       double tolerance, Progress& progress, int& iterations) {
  const std::size_t n = right.size();
  std::vector<double> x(n, 0.0);
  std::vector<double> residual = std::move(right);
  std::vector<double> corrected = system.strong.solve(residual);
  std::vector<double> of_corrected = system.multiply(corrected);
  std::vector<double> direction = corrected;
  std::vector<double> of_direction = of_corrected;
  double weight = dot(corrected, of_corrected);
  std::vector<double> history{system.largest(residual)};
  const auto stalls = [&] {
    return history.size() > kStagnantSteps &&
           history.back() > 0.5 * history[history.size() - 1 - kStagnantSteps];
  };
  // If the system has no solution, the residual ends as a null vector, and further steps would
  // follow rounding.
  const auto ends = [&] { return !(weight > kNull * dot(residual, corrected)); };
  while (history.back() > tolerance && !ends() && history.size() < kMostSteps && !stalls()) {
    const std::vector<double> moved = system.strong.solve(of_direction);
    const double step = weight / dot(of_direction, moved);
    for (std::size_t k = 0; k < n; ++k) {
      x[k] += step * direction[k];
      residual[k] -= step * of_direction[k];
      corrected[k] -= step * moved[k];
    }
    progress.check();
    of_corrected = system.multiply(corrected);
    const double last = std::exchange(weight, dot(corrected, of_corrected));
    for (std::size_t k = 0; k < n; ++k) {
      direction[k] = corrected[k] + weight / last * direction[k];
      of_direction[k] = of_corrected[k] + weight / last * of_direction[k];
    }
    history.push_back(system.largest(residual));
    ++iterations;
  }
  return x;
}

}  // namespace radiosity
