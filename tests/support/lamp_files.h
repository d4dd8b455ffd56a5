// Photometric files of functions of two angles, made for tests.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "radiosity/base.h"

namespace radiosity::test {

/// Angles from one to another, `step` apart.
inline std::vector<double> anglesBy(double from, double to, double step) {
  std::vector<double> angles;
  const auto count = std::size_t(std::lround((to - from) / step)) + 1;
  for (std::size_t k = 0; k < count; ++k) angles.push_back(from + step * double(k));
  return angles;
}

inline double cosineOf(double degrees) { return std::cos(degrees * std::numbers::pi / 180); }
inline double sineOf(double degrees) { return std::sin(degrees * std::numbers::pi / 180); }

/// Of the lamp's frame: z at vertical angle 0, x at C0, y at C90.
inline Vec3 directionOf(double vertical, double horizontal) {
  return {sineOf(vertical) * cosineOf(horizontal), sineOf(vertical) * sineOf(horizontal),
          cosineOf(vertical)};
}

/// A lamp in IES LM-63.
struct IesLamp {
  std::string version = "IESNA:LM-63-2002\n";
  std::string tilt = "TILT=NONE\n";
  std::string lamps = "1 -1";
  double multiplier = 1;
  int type = 1;
  std::string opening = "2 0 0 0";  ///< units, width, length, height
  std::string factors = "1 1 0";
  std::vector<double> vertical{0, 90};
  std::vector<double> horizontal{0};
  std::function<double(double vertical, double horizontal)> candela = [](double, double) {
    return 100.0;
  };

  std::string text() const {
    std::string text = version + "[TEST] made by a test\n" + tilt;
    text += fmt::format("{} {} {} {} {} {}\n{}\n", lamps, multiplier, vertical.size(),
                        horizontal.size(), type, opening, factors);
    text += fmt::format("{}\n{}\n", fmt::join(vertical, " "), fmt::join(horizontal, " "));
    for (const double h : horizontal) {
      for (const double v : vertical) text += fmt::format("{:.9g}\n", candela(v, h));
    }
    return text;
  }
};

/// A lamp in EULUMDAT.
struct EulumdatLamp {
  int symmetry = 0;
  std::vector<double> around = anglesBy(0, 345, 15);
  std::vector<double> gamma = anglesBy(0, 180, 15);
  std::vector<double> rows;                 ///< C angles of which intensities are there
  std::string area = "0\n0\n0\n0\n0\n0\n";  ///< length, width, heights of the luminous area, mm
  std::string ratio = "100";
  std::string conversion = "1";
  std::string sets = "1\n1\nLED\n1000\n3000\n80\n10\n";
  std::function<double(double gamma, double around)> candela = [](double, double) { return 100.0; };

  std::string text() const {
    std::string text = fmt::format("Test\n1\n{}\n{}\n0\n{}\n0\n-\nLamp\n1\nlamp.ldt\ntoday\n",
                                   symmetry, around.size(), gamma.size());
    text += "600\n300\n80\n" + area + "100\n" + ratio + "\n" + conversion + "\n0\n" + sets;
    for (int k = 0; k < 10; ++k) text += "0.5\n";
    for (const double c : around) text += fmt::format("{}\n", c);
    for (const double g : gamma) text += fmt::format("{}\n", g);
    for (const double c : rows) {
      for (const double g : gamma) text += fmt::format("{:.9g}\n", candela(g, c));
    }
    return text;
  }
};

}  // namespace radiosity::test
