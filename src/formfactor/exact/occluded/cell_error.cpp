#include "formfactor/exact/occluded/cell_error.h"

#include <algorithm>
#include <cmath>

#include "formfactor/exact/error_model.h"

namespace radiosity {
namespace {

/// The share of a flat cell's unseen error that is stated.
double flatShare(const CellValues& values) {
  const bool four = values.count == 4;
  // Shadows of one shape keep their edges; others may come and go at the border.
  const double border = values.one_shape ? 0 : kCellFlat;
  if (border < values.fraction && values.fraction < 1 - border) {
    if (!values.one_occluder) return 1;  // one shadow's edge says nothing of another's
    return four ? kCellInside4 : kCellInside9;
  }
  if (four) return kCellBorder4;
  // changeIn() allows for the chance that a kink is in the cell.
  return values.one_shape ? 1 : kCellBorder9 / std::sqrt(values.side);
}

}  // namespace

bool CellValues::flat() const {
  if (!(fraction > 0 && fraction < 1)) return true;
  const auto [least, most] = std::minmax_element(residual.begin(), residual.begin() + count);
  return *most - *least < kCellFlat * whole;
}

double changeIn(int level, double change) {
  const double side = std::ldexp(1.0, -level);
  return std::min(change * side, kMostChange) * std::sqrt(side);
}

double CellValues::unseen() const {
  const bool four = count == 4;
  double share = four ? kCellUnseenSmooth4 : kCellUnseenSmooth9;
  if (!one_shape) share = four ? kCellUnseenKinked4 : kCellUnseenKinked9;
  if (flat()) share = four ? kCellUnseenFlat4 : kCellUnseenFlat9;
  return share * change * whole;
}

double CellValues::seen() const {
  const auto& r = residual;
  if (count == 4) {
    const double along_u = std::abs(r[1] - r[0]) + std::abs(r[3] - r[2]);
    const double along_v = std::abs(r[2] - r[0]) + std::abs(r[3] - r[1]);
    return 0.5 * (along_u + along_v) * (one_shape ? kCellSmooth4 : kCellKinked4);
  }
  const double bend = bendOf(std::span(r).first<9>());
  double slope = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double* row = &r[3 * k];
    const double* column = &r[k];
    slope += kGaussWeight3[k] * (std::abs(row[2] - row[0]) + std::abs(column[6] - column[0]));
  }
  // A kink between the outer points and the border changes the slope there, and nothing else.
  // A step in the middle does not bend: the points lie evenly about it.
  const double of_slope = may_cross && !one_shape ? kCellKinked9 : kCellSlope9;
  return bend * (one_shape ? kCellSmooth9 : kCellKinked9) + slope * of_slope;
}

CellError meanError(const CellValues& values) {
  const double seen = values.seen();
  const double unseen = values.unseen();
  double stated_seen = seen;
  if (!values.one_shape && !values.may_cross) {
    const double strong =
        (values.count == 4 ? kCellStrong4 : kCellStrong9) * values.side * values.whole;
    stated_seen *= std::sqrt(std::min(seen / strong, kCellStrongest));
  }
  const double stated_unseen = values.flat() ? unseen * flatShare(values) : unseen;
  return {std::sqrt(seen * seen + unseen * unseen),
          std::sqrt(stated_seen * stated_seen + stated_unseen * stated_unseen)};
}

CellError meanErrorOutside(const CellError& guessed, double residual) {
  if (!(guessed.cautious > 0)) return guessed;
  const double cautious = std::max(kCellReassured * guessed.cautious, kCellOutside * residual);
  return {cautious, guessed.stated * (cautious / guessed.cautious)};
}

}  // namespace radiosity
