// Photometric files: their symmetries, types and units, their flux, and what is refused.
#include "radiosity/photometry.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "support/lamp_files.h"
#include "support/scene_files.h"

namespace radiosity {
namespace {

using test::anglesBy;
using test::cosineOf;
using test::directionOf;
using test::EulumdatLamp;
using test::IesLamp;
using test::sineOf;

/// Tables have single precision.
constexpr double kSingle = 1e-7;

class PhotometryFiles : public test::SceneFiles {
 protected:
  Photometry ies(const IesLamp& lamp) const {
    return readPhotometry(write("lamp.ies", lamp.text()));
  }
  Photometry ldt(const EulumdatLamp& lamp) const {
    return readPhotometry(write("lamp.ldt", lamp.text()));
  }
  std::string refusedIes(const std::string& text) const { return refused("lamp.ies", text); }
  std::string refusedLdt(const std::string& text) const { return refused("lamp.ldt", text); }

 private:
  /// The message without the folder.
  std::string refused(const std::string& name, const std::string& text) const {
    const std::string file = write(name, text);
    const std::string message = test::inputErrorOf([&] { readPhotometry(file); });
    EXPECT_TRUE(message.starts_with(file)) << message;
    return message.substr(file.size() - name.size());
  }
};

/// With no symmetry at all.
double skewed(double vertical, double around) {
  return 300 + 100 * cosineOf(vertical) + 40 * sineOf(vertical) * cosineOf(around - 20) +
         25 * sineOf(vertical) * sineOf(2 * around + 10);
}

TEST_F(PhotometryFiles, HaveTheFluxOfTheirFunction) {
  IesLamp lamp;
  lamp.vertical = {0, 180};
  EXPECT_NEAR(ies(lamp).flux(), 4 * std::numbers::pi * 100, 4 * std::numbers::pi * 100 * kSingle);
  lamp.vertical = {0, 90};
  EXPECT_NEAR(ies(lamp).flux(), 2 * std::numbers::pi * 100, 2 * std::numbers::pi * 100 * kSingle);
  lamp.vertical = anglesBy(0, 90, 1);
  lamp.candela = [](double v, double) { return 1000 * cosineOf(v); };
  // Straight lines between values of a cosine a degree apart are h^2 / 12 of it below it.
  const double between = std::pow(std::numbers::pi / 180, 2) / 12;
  EXPECT_NEAR(ies(lamp).flux(), std::numbers::pi * 1000 * (1 - between),
              std::numbers::pi * 1000 * between / 100);
}

// The sum over all cells against the midpoint rule over intensity(), which errs by h^2.
TEST_F(PhotometryFiles, HaveTheFluxOfTheirIntensities) {
  const auto midpoints = [](const Photometry& table) {
    double sum = 0;
    constexpr int kSteps = 720;
    for (int i = 0; i < kSteps; ++i) {
      const double v = 180 * (i + 0.5) / kSteps;
      for (int j = 0; j < 2 * kSteps; ++j) {
        const double h = 180 * (j + 0.5) / kSteps;
        sum += table.intensity(directionOf(v, h)) * sineOf(v);
      }
    }
    return sum * std::pow(std::numbers::pi / kSteps, 2);
  };
  IesLamp lamp;
  lamp.candela = skewed;
  lamp.vertical = {0, 10, 45, 90, 120, 180};
  lamp.horizontal = {0, 30, 60, 150, 200, 290, 360};
  EXPECT_NEAR(midpoints(ies(lamp)), ies(lamp).flux(), 1e-5 * ies(lamp).flux());
  for (const int type : {2, 3}) {
    lamp.type = type;
    lamp.vertical = {-90, -40, -5, 10, 60, 90};
    lamp.horizontal = {-90, -45, 0, 20, 90};
    const Photometry table = ies(lamp);
    EXPECT_NEAR(midpoints(table), table.flux(), 1e-3 * table.flux()) << type;  // it ends at a plane
  }
}

TEST_F(PhotometryFiles, AreBilinearInTheirAngles) {
  IesLamp lamp;
  lamp.vertical = {0, 40, 90};
  lamp.horizontal = {0, 90, 180, 360};
  lamp.candela = [](double v, double h) { return 10 + v + h / 10; };
  const Photometry table = ies(lamp);
  // The function is bilinear itself.
  for (const auto& [v, h] : {std::pair{10.0, 0.0}, {30, 45}, {40, 90}, {70, 350}, {89, 200}}) {
    EXPECT_NEAR(table.intensity(directionOf(v, h)), 10 + v + h / 10, 1e-4) << v << " " << h;
    EXPECT_NEAR(table.intensity(7.0 * directionOf(v, h)), 10 + v + h / 10, 1e-4);
  }
  EXPECT_EQ(table.intensity(directionOf(91, 0)), 0);
  EXPECT_EQ(table.intensity({0, 0, -1}), 0);
}

/// Against the whole table of the same function.
void expectSame(const Photometry& a, const Photometry& b) {
  for (const double v : anglesBy(0, 180, 7.5)) {
    for (const double h : anglesBy(0, 355, 5)) {
      EXPECT_NEAR(a.intensity(directionOf(v, h)), b.intensity(directionOf(v, h)), 1e-3)
          << v << " " << h;
    }
  }
}

TEST_F(PhotometryFiles, OfAPartStandForAll) {
  const auto in_quadrants = [](double v, double h) {
    return 100 + 30 * cosineOf(v) + 20 * sineOf(v) * std::abs(cosineOf(h));
  };
  const auto beside_0 = [](double v, double h) { return 100 + 40 * sineOf(v) * cosineOf(h); };
  const auto beside_90 = [](double v, double h) { return 100 + 40 * sineOf(v) * sineOf(h); };
  IesLamp whole;
  whole.vertical = anglesBy(0, 180, 15);
  EulumdatLamp eulumdat;
  // cd for 1000 lm, of which its lamps have 1000.
  const auto compare = [&](const auto& candela, double from, double to, int symmetry) {
    whole.candela = candela;
    whole.horizontal = anglesBy(0, 360, 15);
    const Photometry all = ies(whole);
    IesLamp part = whole;
    part.horizontal = anglesBy(from, to, 15);
    if (symmetry != 3) expectSame(all, ies(part));
    eulumdat.candela = candela;
    eulumdat.symmetry = symmetry;
    eulumdat.rows = part.horizontal;
    expectSame(all, ldt(eulumdat));
  };
  compare(skewed, 0, 345, 0);
  compare(beside_0, 0, 180, 2);
  compare(beside_90, 270, 450, 3);
  compare(in_quadrants, 0, 90, 4);
  whole.candela = beside_90;
  whole.horizontal = anglesBy(0, 360, 15);
  const Photometry all = ies(whole);
  whole.horizontal = anglesBy(90, 270, 15);
  expectSame(all, ies(whole));
  whole.candela = [](double v, double) { return 100 + v; };
  whole.horizontal = {0};
  eulumdat.candela = whole.candela;
  eulumdat.symmetry = 1;
  eulumdat.rows = {0};
  expectSame(ies(whole), ldt(eulumdat));
}

// Planes at 10, 50, ...: at C0 there is a straight line from the last to the first.
TEST_F(PhotometryFiles, APlaneThatIsNotThereLiesBetweenOthers) {
  IesLamp lamp;
  lamp.candela = [](double, double h) { return 100 + h; };
  lamp.horizontal = {90, 100, 170, 270};
  const Photometry table = ies(lamp);
  // C190, the image of C350, has 190 +- : C170 + 20 of 100 degrees to C270.
  EXPECT_NEAR(table.intensity(directionOf(45, 190)), 290, 1e-4);
  EXPECT_NEAR(table.intensity(directionOf(45, 350)), 290, 1e-4);
  EXPECT_NEAR(table.intensity(directionOf(45, 0)), 280, 1e-4);
  EXPECT_NEAR(table.intensity(directionOf(45, 80)), 200, 1e-4);
}

TEST_F(PhotometryFiles, OfTypesAAndBAreThatOfTypeC) {
  // Smooth in the direction: 1 degree apart, straight lines are off by h^2 / 8 of the curvature.
  const auto along = [](const Vec3& d) {
    return 500 + 300 * d.z + 120 * d.x * d.z - 80 * d.y + 60 * d.x * d.y;
  };
  IesLamp c;
  c.vertical = anglesBy(0, 90, 1);
  c.horizontal = anglesBy(0, 360, 1);
  c.candela = [&](double v, double h) { return along(directionOf(v, h)); };
  IesLamp b;
  b.type = 2;
  b.vertical = anglesBy(-90, 90, 1);
  b.horizontal = b.vertical;
  b.candela = [&](double v, double h) {
    return along({sineOf(h), cosineOf(h) * sineOf(v), cosineOf(h) * cosineOf(v)});
  };
  IesLamp a = b;
  a.type = 3;
  a.candela = [&](double v, double h) {
    return along({cosineOf(v) * sineOf(h), sineOf(v), cosineOf(v) * cosineOf(h)});
  };
  const Photometry of_c = ies(c);
  for (const IesLamp& lamp : {b, a}) {
    const Photometry table = ies(lamp);
    EXPECT_NEAR(table.flux(), of_c.flux(), 1e-4 * of_c.flux());
    for (const double v : anglesBy(0.3, 88.3, 4)) {
      for (const double h : anglesBy(0.4, 355.4, 5)) {
        const Vec3 d = directionOf(v, h);
        EXPECT_NEAR(table.intensity(d), along(d), 0.1) << v << " " << h;
        EXPECT_NEAR(of_c.intensity(d), along(d), 0.1) << v << " " << h;
      }
    }
    EXPECT_EQ(table.intensity({0.1, 0.1, -1}), 0);
  }
  // From 0 on, horizontal angles are of both sides.
  IesLamp half = b;
  half.candela = [](double v, double h) { return 200 + v - h * h / 100; };
  const Photometry whole = ies(half);
  half.horizontal = anglesBy(0, 90, 1);
  EXPECT_EQ(ies(half), whole);
}

TEST_F(PhotometryFiles, FactorsAndUnitsCount) {
  IesLamp lamp;
  lamp.multiplier = 3;
  lamp.factors = "0.5 0.8 40";
  lamp.lamps = "2 1500";
  const auto straight = [&] { return ies(lamp).intensity({0, 0, 1}); };
  // The ballast factor; in 1986 the one of ballast and lamp, too.
  EXPECT_NEAR(straight(), 150, 150 * kSingle);
  EXPECT_EQ(ies(lamp).notes.size(), 1U);
  EXPECT_EQ(ies(lamp).lamps, 3000);
  lamp.version = "IES:LM-63-2019\n";
  lamp.factors = "0.5 1.10000 40";  // how it was made, no factor
  EXPECT_NEAR(straight(), 150, 150 * kSingle);
  EXPECT_TRUE(ies(lamp).notes.empty());
  for (const char* version :
       {"IESNA91\n", "IESNA:LM-63-1995\r\n", "\xef\xbb\xbfIESNA:LM-63-2002\n"}) {
    lamp.version = version;
    lamp.factors = "0.5 1 40";
    EXPECT_NEAR(straight(), 150, 150 * kSingle);
  }
  lamp.version = "Series of lamps, by hand\n";
  lamp.factors = "0.5 0.8 40";
  EXPECT_NEAR(straight(), 120, 120 * kSingle);
  lamp.version = "";
  lamp.tilt = "TILT=INCLUDE\n1\n3\n0 45 90\n1.0 1 1\n";
  EXPECT_NEAR(straight(), 120, 120 * kSingle);
  EXPECT_EQ(
      readPhotometry(write("a.ies", "TILT=NONE\n1,-1,1,\n2,1,1,2,0,0,0,1,1 ,0\r\n0,90,0\n5, 5\x1a"))
          .candela,
      std::vector<float>(2, 5));

  EulumdatLamp eulumdat;
  eulumdat.rows = eulumdat.around;
  eulumdat.conversion = "0,5";
  eulumdat.sets = "2\n1\nT5\n2000\n3000\n80\n10\n-1\nLED\n1000,0\n\n\n\n";
  eulumdat.ratio = "80";
  const Photometry table = ldt(eulumdat);
  EXPECT_NEAR(table.intensity({1, 2, 3}), 100 * 3 * .5, 150 * kSingle);
  EXPECT_EQ(table.lamps, 3000);
  EXPECT_EQ(table.stated, 2400);
}

// The shapes of LM-63-1995 and -2002, and of EULUMDAT, in the lamp's frame.
TEST_F(PhotometryFiles, HaveAnOpening) {
  const auto shape = [&](const std::string& opening, int type = 1) {
    IesLamp lamp;
    lamp.opening = opening;
    lamp.type = type;
    if (type != 1) lamp.vertical = lamp.horizontal = {-90, 90};
    const Photometry table = ies(lamp);
    return std::pair(table.opening, table.round);
  };
  EXPECT_EQ(shape("2 0 0 0"), std::pair(Vec3(0.0), false));
  EXPECT_EQ(shape("2 .3 1.2 .1"), std::pair(Vec3(1.2, .3, .1), false));
  EXPECT_NEAR(shape("1 1 2 0").first.x, 0.6096, 1e-15);
  EXPECT_EQ(shape("2 -.4 0 0"), std::pair(Vec3(.4, .4, 0), true));
  EXPECT_EQ(shape("2 -.4 -.4 0"), std::pair(Vec3(.4, .4, 0), true));
  EXPECT_EQ(shape("2 -.4 .6 0"), std::pair(Vec3(.6, .4, 0), true));
  EXPECT_EQ(shape("2 -.4 0 -.4"), std::pair(Vec3(.4), true));
  EXPECT_EQ(shape("2 -.4 0 1"), std::pair(Vec3(.4, .4, 1), true));
  EXPECT_EQ(shape("2 0 1 -.1"), std::pair(Vec3(1, .1, .1), false));
  EXPECT_EQ(shape("2 .3 1.2 .1", 2), std::pair(Vec3(.3, 1.2, .1), false));
  EXPECT_EQ(shape("2 .3 1.2 .1", 3), std::pair(Vec3(.3, .1, 1.2), false));

  EulumdatLamp lamp;
  lamp.rows = lamp.around;
  lamp.area = "1200\n300\n40\n40\n40\n40\n";
  EXPECT_NEAR(glm::distance(ldt(lamp).opening, Vec3(.3, 1.2, .04)), 0, 1e-15);
  lamp.area = "250\n0\n0\n0\n0\n0\n";
  EXPECT_NEAR(glm::distance(ldt(lamp).opening, Vec3(.25, .25, 0)), 0, 1e-15);
  EXPECT_TRUE(ldt(lamp).round);
}

TEST_F(PhotometryFiles, OtherLumensAreSaid) {
  IesLamp lamp;
  lamp.lamps = "2 100";  // a hemisphere of 100 cd has 628 lm
  ASSERT_EQ(ies(lamp).remarks().size(), 1U);
  EXPECT_EQ(ies(lamp).remarks()[0], "its table gives 628.319 lm, and its lamps 200 lm");
  lamp.lamps = "1 1000";  // a luminaire keeps a part of it
  EXPECT_TRUE(ies(lamp).remarks().empty());
  EulumdatLamp eulumdat;
  eulumdat.rows = eulumdat.around;  // 1256.6 lm for 1000
  ASSERT_EQ(ldt(eulumdat).remarks().size(), 1U);
  EXPECT_EQ(ldt(eulumdat).remarks()[0], "its table gives 1256.64 lm, and it states 1000 lm");
  eulumdat.ratio = "125";
  EXPECT_TRUE(ldt(eulumdat).remarks().empty());
}

TEST_F(PhotometryFiles, AreTheSameAsTexts) {
  IesLamp lamp;
  lamp.candela = skewed;
  lamp.opening = "1 -1.3 0 .7";
  lamp.vertical = {0, 22.5, 61.803398874989, 90};
  lamp.horizontal = anglesBy(0, 345, 15);
  lamp.lamps = "3 1234.5";
  for (const int type : {1, 2}) {
    lamp.type = type;
    if (type == 2) lamp.vertical = lamp.horizontal = {-90, -33.3, 1e-3, 90};
    const Photometry table = ies(lamp);
    const std::string text = table.text();
    EXPECT_EQ(text.find_first_of("%,;= \n\t"), std::string::npos);
    EXPECT_EQ(Photometry::ofText(text), table);
    EXPECT_EQ(Photometry::ofText(text).text(), text);
  }
  const std::string text = ies(lamp).text();
  // Whatever is cut off, it is refused or a table that holds what it must.
  for (std::size_t size = 0; size < text.size(); ++size) {
    try {
      Photometry::ofText(text.substr(0, size)).validate();
    } catch (const InputError&) {
    }
  }
  LampFile file;
  EXPECT_TRUE(file.readOption("a%20b.ies|" + text));
  EXPECT_EQ(file.name(), "a b.ies");
  EXPECT_EQ(file.optionText(), "a%20b.ies|" + text);
}

TEST_F(PhotometryFiles, OfIesThatAreNoneAreRefused) {
  const IesLamp good;
  const auto with = [&](const std::string& part, const std::string& other) {
    std::string text = good.text();
    const std::size_t at = text.find(part);
    EXPECT_NE(at, text.npos) << part;
    return refusedIes(text.replace(at, part.size(), other));
  };
  EXPECT_EQ(refusedIes(""), "lamp.ies: the file is empty; export it again");
  EXPECT_CONTAINS(refusedIes(std::string("\0\x01\xff\xfe binary", 11)), "has no line TILT=");
  EXPECT_CONTAINS(with("TILT=NONE", "TILT=lamp.tlt"),
                  "lamp.ies:3: TILT=lamp.tlt is a file of its own");
  EXPECT_CONTAINS(with("TILT=NONE", "TILT=INCLUDE\n1\n2\n0 90\n1 .9"), "write TILT=NONE");
  EXPECT_CONTAINS(with("1 -1 1 2 1 1", "1 -1 1 1000000000 1 1"),
                  "the file is too short for so many");
  EXPECT_CONTAINS(with("1 -1 1 2 1 1", "1 -1 1 1e300 1 1"), "the file is too short for so many");
  EXPECT_CONTAINS(with("1 -1 1 2 1 1", "1 -1 1 2 9 1"), "the file is too short for so many");
  EXPECT_CONTAINS(with("1 -1 1 2 1 1", "1 -1 1 2 1.5 1"), "the number of horizontal angles is 1.5");
  EXPECT_CONTAINS(with("1 -1 1 2 1 1", "1 -1 0 2 1 1"), "the candela multiplier is 0");
  EXPECT_CONTAINS(with("1 -1 1 2 1 1", "1 -1 1 2 1 4"), "the type of photometry is 4; it is 1 (C)");
  EXPECT_CONTAINS(with("1 2 0 0 0", "1 3 0 0 0"), "the type of units is 3; it is 1 (feet) or 2");
  EXPECT_CONTAINS(with("0 90\n", "90 0\n"),
                  "lamp.ies:6: vertical angle 0 follows 90; angles ascend");
  EXPECT_CONTAINS(with("0 90\n", "0 0\n"), "vertical angle 0 follows 0");
  EXPECT_CONTAINS(with("0 90\n", "0 85\n"), "vertical angles from 0 to 85; they go from 0 to 90");
  EXPECT_CONTAINS(with("0 90\n0\n", "0 90\n45\n"),
                  "horizontal angles from 45 to 45; they are 0 alone");
  EXPECT_CONTAINS(with("\n100\n", "\nnan\n"), "candela `nan` is not a finite number");
  EXPECT_CONTAINS(with("\n100\n", "\ninf\n"), "candela `inf` is not a finite number");
  EXPECT_CONTAINS(with("\n100\n", "\n-3\n"), "lamp.ies:8: an intensity below 0, -3 cd");
  EXPECT_CONTAINS(with("\n100\n", "\n1e60\n"), "an intensity beyond all lamps");
  EXPECT_CONTAINS(refusedIes(good.text() + "7\n"),
                  "lamp.ies:10: more numbers than 2 vertical and 1");
  const std::string whole = good.text();
  for (std::size_t size = 1; size + 4 < whole.size(); ++size) {
    EXPECT_NE(refusedIes(whole.substr(0, size)), "") << size;
  }
  IesLamp dark;
  dark.candela = [](double, double) { return 0; };
  EXPECT_EQ(refusedIes(dark.text()), "lamp.ies: all intensities are 0; export it again");
  IesLamp flood;
  flood.type = 2;
  EXPECT_CONTAINS(refusedIes(flood.text()),
                  "vertical angles of type B from 0 to 90; they go from -90");
  EXPECT_CONTAINS(test::inputErrorOf([&] { readPhotometry(path("none.ies")); }), "no such file");
  EXPECT_CONTAINS(test::inputErrorOf([&] { readPhotometry(write("a.txt", "1")); }),
                  "a.txt: is no file of a lamp; give one of IES LM-63 (.ies) or EULUMDAT (.ldt)");
}

TEST_F(PhotometryFiles, OfEulumdatThatAreNoneAreRefused) {
  EulumdatLamp good;
  good.rows = good.around;
  const std::string whole = good.text();
  const auto with = [&](std::size_t line, const std::string& other) {
    std::string text = whole;
    std::size_t at = 0;
    for (std::size_t k = 1; k < line; ++k) at = text.find('\n', at) + 1;
    return refusedLdt(text.replace(at, text.find('\n', at) - at, other));
  };
  EXPECT_EQ(refusedLdt(""), "lamp.ldt: the file is empty; export it again");
  EXPECT_CONTAINS(refusedLdt("\n\n"), "ends before the symmetry, line 3");
  EXPECT_CONTAINS(refusedLdt(std::string("\0\x01\xff\xfe\n\n7\n", 8)),
                  "the symmetry is 7; it is 0 to 4");
  EXPECT_CONTAINS(with(3, "5"), "lamp.ldt:3: the symmetry is 5; it is 0 to 4");
  EXPECT_CONTAINS(with(4, "1000000000"), "the file ends here, and 1000000000 C-planes");
  EXPECT_CONTAINS(with(6, "1000000000"), "intensities take more lines");
  EXPECT_CONTAINS(with(6, "12"), "more lines than 24 x 12 intensities take");
  EXPECT_CONTAINS(with(24, "0"), "lamp.ldt:24: the conversion factor is not above 0; write 1");
  EXPECT_CONTAINS(with(26, "0"), "the number of sets of lamps is 0; give a whole number from 1");
  EXPECT_CONTAINS(with(29, "0"), "lamp.ldt:29: the lumens of the lamps are not above 0");
  EXPECT_CONTAINS(with(45, "1"), "C angle 1 follows 15");
  EXPECT_CONTAINS(with(43, "1"),
                  "intensities from C1 to C360 with the symmetry 0; they go from C0 to C360");
  EXPECT_CONTAINS(with(67, "20"), "gamma angle 15 follows 20");
  EXPECT_CONTAINS(with(79, "170"), "gamma angles from 0 to 170; they go from 0 to 90");
  EXPECT_CONTAINS(with(90, "-1"), "lamp.ldt:90: an intensity below 0, -1 cd");
  EXPECT_CONTAINS(with(90, "nan"), "lamp.ldt:90: intensity `nan` is not a finite number");
  EXPECT_CONTAINS(with(90, "1.2.3"), "intensity `1.2.3` is not a finite number");
  for (std::size_t size = 1; size + 4 < whole.size(); size += 17) {
    EXPECT_NE(refusedLdt(whole.substr(0, size)), "") << size;
  }
  good.candela = [](double, double) { return 0; };
  EXPECT_EQ(refusedLdt(good.text()), "lamp.ldt: all intensities are 0; export it again");
}

}  // namespace
}  // namespace radiosity
