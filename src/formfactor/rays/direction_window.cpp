#include "formfactor/rays/direction_window.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace radiosity {

using std::numbers::pi;

double DirectionWindow::share() const { return empty() ? 0.0 : (high - low) * half / pi; }

bool DirectionWindow::contains(const DirectionWindow& other) const {
  if (other.empty()) return true;
  if (!(low <= other.low && other.high <= high)) return false;
  return half >= pi || std::abs(std::remainder(other.centre - centre, 2 * pi)) + other.half <= half;
}

void DirectionWindow::add(const DirectionWindow& other) {
  if (other.empty()) return;
  if (empty()) {
    *this = other;
    return;
  }
  low = std::min(low, other.low);
  high = std::max(high, other.high);
  const double turn = std::remainder(other.centre - centre, 2 * pi);
  const double from = std::min(-half, turn - other.half);
  const double to = std::max(half, turn + other.half);
  centre += 0.5 * (from + to);
  half = std::min(0.5 * (to - from), pi);
}

}  // namespace radiosity
