// Tables of luminous intensity: values between the angles, and the flux of all.
#include "radiosity/photometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <span>

#include "base/finite.h"

namespace radiosity {

namespace {

constexpr double kWholeTurn = 360;

double toDegrees(double radians) { return radians * 180 / std::numbers::pi; }
double toRadians(double degrees) { return degrees * std::numbers::pi / 180; }

/// The two angles of a direction, degrees.
struct TwoAngles {
  double vertical;
  double horizontal;
};

TwoAngles anglesOf(PhotometryType type, const Vec3& d) {
  switch (type) {
    case PhotometryType::c: {
      const double around = toDegrees(std::atan2(d.y, d.x));
      return {toDegrees(std::atan2(std::hypot(d.x, d.y), d.z)),
              around < 0 ? around + kWholeTurn : around};
    }
    case PhotometryType::b:
      return {toDegrees(std::atan2(d.y, d.z)), toDegrees(std::atan2(d.x, std::hypot(d.y, d.z)))};
    case PhotometryType::a:
      return {toDegrees(std::atan2(d.y, std::hypot(d.x, d.z))), toDegrees(std::atan2(d.x, d.z))};
  }
  return {0, 0};
}

/// The interval of ascending angles in which one is, and how far: 0 to 1.
struct Between {
  std::size_t first;
  double share;
};

/// Within the first and the last angle.
Between betweenAngles(std::span<const double> angles, double angle) {
  const auto above = std::ranges::upper_bound(angles, angle) - angles.begin();
  const auto first =
      std::size_t(std::clamp<std::ptrdiff_t>(above - 1, 0, std::ptrdiff_t(angles.size()) - 2));
  return {first, (angle - angles[first]) / (angles[first + 1] - angles[first])};
}

bool isWithin(std::span<const double> angles, double angle) {
  return angle >= angles.front() && angle <= angles.back();
}

enum class Weight { one, sine, cosine };

/// The integrals of two functions over an interval of angles, times the weight: of the one that
/// falls from 1 to 0, and of the one that rises.
struct HalfHats {
  double falling;
  double rising;
};

// Of the sine: the integral of (b - x) sin x / (b - a) is cos a - (sin b - sin a) / (b - a).
HalfHats halfHats(double from, double to, Weight weight) {
  const double width = toRadians(to - from);
  if (weight == Weight::one) return {width / 2, width / 2};
  const double shift = weight == Weight::cosine ? 90 : 0;  // cos x = sin(x + 90)
  const double a = toRadians(from + shift);
  const double b = toRadians(to + shift);
  constexpr double kNarrow = 1e-5;  // the midpoint is off by 1e-11 of it, differences of sines more
  if (width < kNarrow) {
    const double half = width / 2 * std::sin((a + b) / 2);
    return {half, half};
  }
  const double slope = (std::sin(b) - std::sin(a)) / width;
  return {std::cos(a) - slope, slope - std::cos(b)};
}

/// The integral of the hat of each angle, times the weight.
std::vector<double> hats(std::span<const double> angles, Weight weight) {
  std::vector<double> sums(angles.size(), 0.0);
  for (std::size_t k = 0; k + 1 < angles.size(); ++k) {
    const HalfHats halves = halfHats(angles[k], angles[k + 1], weight);
    sums[k] += halves.falling;
    sums[k + 1] += halves.rising;
  }
  return sums;
}

/// Ascending, finite, within bounds.
void checkAngles(std::span<const double> angles, const char* what, double low, double high) {
  for (std::size_t k = 0; k < angles.size(); ++k) {
    if (!std::isfinite(angles[k]) || angles[k] < low || angles[k] > high) {
      throw InputError(fmt::format("{} angle {} is not within {} to {} degrees; correct it", what,
                                   angles[k], low, high));
    }
    if (k > 0 && !(angles[k] > angles[k - 1])) {
      throw InputError(fmt::format("{} angle {} follows {}; angles ascend, none is there twice",
                                   what, angles[k], angles[k - 1]));
    }
  }
}

/// More than these apart, a file's lumens and its table are worth a word.
constexpr double kApart = 0.05;

}  // namespace

double Photometry::intensity(const Vec3& direction) const {
  const TwoAngles at = anglesOf(type, direction);
  if (!isWithin(vertical, at.vertical)) return 0;
  const Between v = betweenAngles(vertical, at.vertical);
  const auto inRow = [&](std::size_t row) {
    const float* values = candela.data() + row * vertical.size() + v.first;
    return (1 - v.share) * double(values[0]) + v.share * double(values[1]);
  };
  if (horizontal.size() == 1) return inRow(0);
  if (!isWithin(horizontal, at.horizontal)) return 0;
  const Between h = betweenAngles(horizontal, at.horizontal);
  return (1 - h.share) * inRow(h.first) + h.share * inRow(h.first + 1);
}

double Photometry::flux() const {
  const Weight of_vertical = type == PhotometryType::c   ? Weight::sine
                             : type == PhotometryType::a ? Weight::cosine
                                                         : Weight::one;
  const std::vector<double> v = hats(vertical, of_vertical);
  std::vector<double> h{2 * std::numbers::pi};
  if (horizontal.size() > 1) {
    h = hats(horizontal, type == PhotometryType::b ? Weight::cosine : Weight::one);
  }
  double sum = 0;
  for (std::size_t row = 0; row < h.size(); ++row) {
    double of_row = 0;
    for (std::size_t k = 0; k < v.size(); ++k) {
      of_row += v[k] * double(candela[row * v.size() + k]);
    }
    sum += h[row] * of_row;
  }
  return sum;
}

double Photometry::size() const {
  const Vec3& o = opening;
  if (round) return std::hypot(std::max(o.x, o.y), o.z);
  return glm::length(o);
}

std::vector<std::string> Photometry::remarks() const {
  std::vector<std::string> all = notes;
  const double whole = flux();
  if (stated > 0) {
    if (std::abs(whole - stated) <= kApart * stated) return all;
    all.push_back(fmt::format("its table gives {:.6g} lm, and it states {:.6g} lm", whole, stated));
  } else if (lamps > 0 && whole > (1 + kApart) * lamps) {
    all.push_back(fmt::format("its table gives {:.6g} lm, and its lamps {:.6g} lm", whole, lamps));
  }
  return all;
}

void Photometry::validate() const {
  const bool of_c = type == PhotometryType::c;
  if (vertical.size() < 2 || horizontal.empty() ||
      candela.size() / vertical.size() != horizontal.size() ||
      candela.size() % vertical.size() != 0) {
    throw InputError(fmt::format(
        "{} vertical and {} horizontal angles have {} intensities; there is one for each pair",
        vertical.size(), horizontal.size(), candela.size()));
  }
  checkAngles(vertical, "vertical", of_c ? 0 : -90, of_c ? 180 : 90);
  checkAngles(horizontal, "horizontal", of_c ? 0 : -90, of_c ? kWholeTurn : 90);
  if (horizontal.size() == 1 && !(of_c && horizontal[0] == 0)) {
    throw InputError("a single horizontal angle is 0, and of type C");
  }
  bool any = false;
  for (const float value : candela) {
    if (!std::isfinite(value) || value < 0) {
      throw InputError(fmt::format("intensity {} is not a finite number of 0 or more", value));
    }
    any = any || value > 0;
  }
  if (!any) throw InputError("all intensities are 0");
  if (!isFinite(opening) || opening.x < 0 || opening.y < 0 || opening.z < 0) {
    throw InputError("the opening is not of finite size");
  }
  if (!std::isfinite(lamps) || !std::isfinite(stated) || !(flux() > 0) || !std::isfinite(flux())) {
    throw InputError("its lumens are not finite numbers above 0");
  }
}

bool Photometry::operator==(const Photometry& other) const {
  return type == other.type && vertical == other.vertical && horizontal == other.horizontal &&
         candela == other.candela && opening == other.opening && round == other.round &&
         lamps == other.lamps && stated == other.stated;
}

}  // namespace radiosity
