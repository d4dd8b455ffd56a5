#include "formfactor/exact/occluded/cell_error.h"

#include <algorithm>
#include <cmath>

namespace radiosity {
namespace {

/// Values that differ by less, in whole form factors, are flat.
constexpr double kFlat = 0.05;

/// Shares of first differences (2 x 2), and of second differences and slopes (3 x 3).
constexpr double kSmooth4 = 0.010;
constexpr double kKinked4 = 0.038;
constexpr double kSmooth9 = 0.003;
constexpr double kKinked9 = 0.022;
constexpr double kSlope9 = 0.002;
/// Shares of the change, of what no difference shows: where values are flat; where there is a kink,
/// so that differences may be small by chance; and where there seems to be none.
constexpr double kUnseenFlat4 = 0.011;
constexpr double kUnseenKinked4 = 0.011;
constexpr double kUnseenSmooth4 = 0.004;
constexpr double kUnseenFlat9 = 0.0055;
constexpr double kUnseenKinked9 = 0.002;
constexpr double kUnseenSmooth9 = 0.0006;
/// Of the seen part of the cautious estimate, in whole form factors and sides of the cell: where it
/// is as much, kinks are as strong as it says; and where they grow no stronger.
constexpr double kStrong4 = 0.0163;
constexpr double kStrong9 = 0.0067;
constexpr double kStrongest = 6;
/// Of the unseen part, in flat cells: where the shadow's edge is well inside the target, and where
/// it is at its border or not seen at all (3 x 3: where shapes differ, and a kink is known to be).
constexpr double kInside4 = 0.36;
constexpr double kInside9 = 0.22;
constexpr double kBorder4 = 1.25;
constexpr double kBorder9 = 0.75;
/// Of residuals near the corners, and of an error guessed before they were seen.
constexpr double kOutside = 0.0135;
constexpr double kReassured = 0.2;

/// Of what is unseen in a flat cell, what is stated.
double flatShare(const CellValues& values) {
  const bool four = values.count == 4;
  // Shadows of one shape have their edges where they are; others come and go at the border.
  const double border = values.one_shape ? 0 : kFlat;
  if (border < values.fraction && values.fraction < 1 - border) {
    if (!values.one_occluder) return 1;  // one shadow's edge says nothing of another's
    return four ? kInside4 : kInside9;
  }
  if (four) return kBorder4;
  // changeIn reckons with the chance that a kink is in the cell.
  return values.one_shape ? 1 : kBorder9 / std::sqrt(values.side);
}

}  // namespace

bool CellValues::flat() const {
  if (!(fraction > 0 && fraction < 1)) return true;
  const auto [least, most] = std::minmax_element(residual.begin(), residual.begin() + count);
  return *most - *least < kFlat * whole;
}

double changeIn(int level, double change) {
  const double side = std::ldexp(1.0, -level);
  return std::min(change * side, kMostChange) * std::sqrt(side);
}

double CellValues::unseen() const {
  const bool four = count == 4;
  double share = four ? kUnseenSmooth4 : kUnseenSmooth9;
  if (!one_shape) share = four ? kUnseenKinked4 : kUnseenKinked9;
  if (flat()) share = four ? kUnseenFlat4 : kUnseenFlat9;
  return share * change * whole;
}

double CellValues::seen() const {
  const auto& r = residual;
  if (count == 4) {
    const double along_u = std::abs(r[1] - r[0]) + std::abs(r[3] - r[2]);
    const double along_v = std::abs(r[2] - r[0]) + std::abs(r[3] - r[1]);
    return 0.5 * (along_u + along_v) * (one_shape ? kSmooth4 : kKinked4);
  }
  double bend = 0;
  double slope = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double* row = &r[3 * k];
    const double* column = &r[k];
    bend += kGaussWeight3[k] * std::abs(row[0] - 2 * row[1] + row[2]);
    bend += kGaussWeight3[k] * std::abs(column[0] - 2 * column[3] + column[6]);
    slope += kGaussWeight3[k] * (std::abs(row[2] - row[0]) + std::abs(column[6] - column[0]));
  }
  // A kink between the outer points and the border changes the slope there, and nothing else.
  // A step in the middle does not bend: the points lie evenly about it.
  const double of_slope = may_cross && !one_shape ? kKinked9 : kSlope9;
  return bend * (one_shape ? kSmooth9 : kKinked9) + slope * of_slope;
}

CellError meanError(const CellValues& values) {
  const double seen = values.seen();
  const double unseen = values.unseen();
  double stated_seen = seen;
  if (!values.one_shape && !values.may_cross) {
    const double strong = (values.count == 4 ? kStrong4 : kStrong9) * values.side * values.whole;
    stated_seen *= std::sqrt(std::min(seen / strong, kStrongest));
  }
  const double stated_unseen = values.flat() ? unseen * flatShare(values) : unseen;
  return {std::sqrt(seen * seen + unseen * unseen),
          std::sqrt(stated_seen * stated_seen + stated_unseen * stated_unseen)};
}

CellError meanErrorOutside(const CellError& guessed, double residual) {
  if (!(guessed.cautious > 0)) return guessed;
  const double cautious = std::max(kReassured * guessed.cautious, kOutside * residual);
  return {cautious, guessed.stated * (cautious / guessed.cautious)};
}

}  // namespace radiosity
