#include "mesh/cells/size_search.h"

#include <algorithm>
#include <limits>

namespace radiosity {

double sizeForCount(double start, double largest, double wanted,
                    const std::function<double(double)>& count) {
  constexpr int kMostCalls = 8;
  constexpr double kCloseEnough = 0.02;
  double too_fine = 0;  // largest size known to give too many
  double too_coarse = std::numeric_limits<double>::infinity();
  double size = start;
  double best = start;
  double best_error = std::numeric_limits<double>::infinity();
  double last_count = 0;
  int unchanged = 0;
  for (int call = 0; call < kMostCalls; ++call) {
    const double n = count(size);
    const double error = std::abs(std::log(n / wanted));
    if (error < best_error) {
      best_error = error;
      best = size;
    }
    if (error < kCloseEnough) break;
    unchanged = n == last_count ? unchanged + 1 : 0;
    if (unchanged == 2) break;
    last_count = n;
    (n > wanted ? too_fine : too_coarse) = size;
    // Newton's step on log(count) = -2 log(size) + c, kept inside the bracket.
    double next = size * std::clamp(std::sqrt(n / wanted), 0.25, 4.0);
    if (next <= too_fine || next >= too_coarse) next = std::sqrt(too_fine * too_coarse);
    if (size == largest && next >= largest) break;
    size = std::min(next, largest);
  }
  return best;
}

}  // namespace radiosity
