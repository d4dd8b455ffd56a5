// IES LM-63: lines of text up to TILT=, then numbers between blanks or commas.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/lower_case.h"
#include "base/printable.h"
#include "scene/lights/photometry/plane_circle.h"
#include "scene/lights/photometry/readers.h"
#include "scene/mesh_cursor.h"

namespace radiosity {

namespace {

constexpr double kMetresPerFoot = 0.3048;
/// DOS ends a text with the one, Windows begins one with the other.
constexpr char kEndOfText = 0x1a;
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

/// Numbers are separated by blanks or commas.
std::string withoutCommas(std::string_view content) {
  std::string text(content);
  std::ranges::replace(text, ',', ' ');
  while (!text.empty() && (text.back() == kEndOfText || text.back() == '\0')) text.pop_back();
  return text;
}

class IesReader {
 public:
  IesReader(const std::string& file, std::string_view content)
      : file_(file), text_(withoutCommas(content)), cursor_(file, text_) {}

  Photometry read() {
    readHeader();
    readLamp();
    readAngles("vertical", vertical_count_, table_.vertical);
    checkVertical();
    readAngles("horizontal", horizontal_count_, angles_);
    checkHorizontal();
    readRows();
    if (!cursor_.atEnd()) {
      cursor_.word();
      cursor_.fail(fmt::format(
          "more numbers than {} vertical and {} horizontal angles take; export it again",
          vertical_count_, horizontal_count_));
    }
    fill();
    return std::move(table_);
  }

 private:
  double number(const char* what) { return cursor_.number(NumberType::f64, what); }

  /// A count may be written as 37.0.
  std::size_t count(const char* what, const char* of) {
    const double given = number(what);
    if (!(given >= 1) || given != std::floor(given)) {
      cursor_.fail(fmt::format("{} is {}; give a whole number of 1 or more", what, given));
    }
    constexpr double kMost = 1e15;
    cursor_.require(std::size_t(std::min(given, kMost)), of, NumberType::f64);
    return std::size_t(given);
  }

  double factor(const char* what) {
    const double given = number(what);
    if (!(given > 0)) cursor_.fail(fmt::format("{} is {}; give a number above 0", what, given));
    return given;
  }

  void readHeader() {
    for (bool first = true;; first = false) {
      if (cursor_.atEnd()) {
        throw InputError(fmt::format(
            "{}: has no line TILT=, which stands before the numbers of IES LM-63; export it again",
            file_));
      }
      std::string line = lowerCase(cursor_.nextLine());
      if (first) {
        if (line.starts_with(kByteOrderMark)) line.erase(0, kByteOrderMark.size());
        has_version_ = line.starts_with("iesna") || line.starts_with("ies:");
        is_2019_ = has_version_ && line.find("2019") != line.npos;
      }
      if (!line.starts_with("tilt=")) continue;
      std::string tilt = line.substr(5);
      tilt.erase(0, tilt.find_first_not_of(' '));
      if (tilt == "include") return readTilt();
      if (tilt == "none") return;
      cursor_.fail(
          fmt::format("TILT={} is a file of its own, which is not read; write TILT=NONE if the "
                      "lamp hangs as it "
                      "was measured",
                      printable(tilt)));
    }
  }

  /// Factors by how far the lamp is tilted off the position in which it was measured. How that goes
  /// with where a light points, the file does not tell.
  void readTilt() {
    number("the lamp's position");
    const std::size_t angles = count("the number of tilts", "tilts");
    for (std::size_t k = 0; k < angles; ++k) number("tilt");
    for (std::size_t k = 0; k < angles; ++k) {
      if (number("factor of a tilt") == 1) continue;
      cursor_.fail(
          "the lamp gives another flux where it is tilted (TILT=INCLUDE), which is not computed; "
          "write TILT=NONE, without the lines of the tilt, if it hangs as it was measured");
    }
  }

  void readLamp() {
    const double lamps = factor("the number of lamps");
    const double lumens = number("lumens per lamp");
    factor_ = factor("the candela multiplier");
    vertical_count_ = count("the number of vertical angles", "vertical angles");
    horizontal_count_ = count("the number of horizontal angles", "horizontal angles");
    if (vertical_count_ < 2) cursor_.fail("there is one vertical angle; give at least two");
    cursor_.require(vertical_count_ * horizontal_count_, "intensities", NumberType::f64);
    readType();
    readOpening();
    factor_ *= factor("the ballast factor");
    const double future = number("the factor after the ballast's");
    if (!has_version_) {
      if (!(future > 0)) cursor_.fail("the ballast-lamp factor is not above 0; write 1");
      factor_ *= future;
    } else if (!is_2019_ && future != 1) {
      table_.notes.push_back(fmt::format(
          "the number after its ballast factor, {}, is for future use and not used", future));
    }
    number("input watts");
    if (lumens > 0) table_.lamps = lamps * lumens;
  }

  void readType() {
    const double type = number("the type of photometry");
    if (type == 1) return;
    if (type != 2 && type != 3) {
      cursor_.fail(fmt::format("the type of photometry is {}; it is 1 (C), 2 (B) or 3 (A)", type));
    }
    table_.type = type == 2 ? PhotometryType::b : PhotometryType::a;
  }

  /// LM-63-1995 and -2002: a negative width or length is of an ellipse, a length of 0 beside it of
  /// a circle; a negative height of a body that is round in that direction, too. Its box is taken.
  /// The length lies in the plane of horizontal angle 0, the width across it.
  void readOpening() {
    const double units = number("the type of units");
    if (units != 1 && units != 2) {
      cursor_.fail(fmt::format("the type of units is {}; it is 1 (feet) or 2 (metres)", units));
    }
    const double metres = units == 1 ? kMetresPerFoot : 1;
    double width = metres * number("the width of the opening");
    double length = metres * number("the length of the opening");
    const double height = metres * number("the height of the opening");
    const bool round = width < 0 || length < 0;
    width = std::abs(width);
    length = std::abs(length);
    const double other = height < 0 ? -height : 0;
    if (width == 0) width = round ? length : other;
    if (length == 0) length = round ? width : other;
    const double high = std::abs(height);
    switch (table_.type) {
      case PhotometryType::c:
        table_.opening = {length, width, high};
        break;
      case PhotometryType::b:
        table_.opening = {width, length, high};
        break;
      case PhotometryType::a:
        table_.opening = {width, high, length};
        break;
    }
    table_.round = round && table_.type != PhotometryType::a;
  }

  void readAngles(const char* what, std::size_t count, std::vector<double>& angles) {
    const std::string named = fmt::format("{} angle", what);
    for (std::size_t k = 0; k < count; ++k) {
      const double angle = number(named.c_str());
      if (k > 0 && !(angle > angles.back())) {
        cursor_.fail(fmt::format("{} {} follows {}; angles ascend, none is there twice", named,
                                 angle, angles.back()));
      }
      angles.push_back(angle);
    }
    constexpr double kOneTurn = 360;
    if (std::max(-angles.front(), angles.back()) > kOneTurn) {
      cursor_.fail(
          fmt::format("{}s go from {} to {}; correct them", named, angles.front(), angles.back()));
    }
  }

  void checkVertical() {
    const double first = table_.vertical.front();
    const double last = table_.vertical.back();
    if (table_.type == PhotometryType::c) {
      if (isVerticalRange(first, last)) return;
      cursor_.fail(fmt::format("vertical angles from {} to {}; {}", first, last, kVerticalRanges));
    }
    checkAhead("vertical", first, last);
  }

  /// Of types A and B: both sides of 0, up to 90.
  void checkAhead(const char* what, double first, double last) {
    if (first < 0 && first >= -90 && last > 0 && last <= 90) {
      if (first > -90 || last < 90) {
        table_.notes.push_back(fmt::format(
            "beyond its {} angles, {} to {} degrees, it is taken to be dark", what, first, last));
      }
      return;
    }
    cursor_.fail(fmt::format("{} angles of type {} from {} to {}; they go from -90 to 90", what,
                             table_.type == PhotometryType::a ? "A" : "B", first, last));
  }

  void readRows() {
    const auto refuse = [this](const char* what, double value) {
      cursor_.fail(fmt::format("{}, {} cd; correct it", what, value));
    };
    for (std::size_t h = 0; h < horizontal_count_; ++h) {
      std::vector<float>& row = rows_.emplace_back();
      for (std::size_t v = 0; v < vertical_count_; ++v) {
        row.push_back(candelaOf(factor_ * number("candela"), refuse));
      }
    }
  }

  /// Types A and B: the angles from 0 on stand for both sides.
  void fillAhead() {
    if (angles_.front() == 0) {
      std::vector<double> left;
      std::vector<std::vector<float>> rows;
      for (std::size_t k = angles_.size() - 1; k > 0; --k) {
        left.push_back(-angles_[k]);
        rows.push_back(rows_[k]);
      }
      angles_.insert(angles_.begin(), left.begin(), left.end());
      rows_.insert(rows_.begin(), rows.begin(), rows.end());
    }
    asTheyAre();
  }

  void asTheyAre() {
    table_.horizontal = angles_;
    for (const std::vector<float>& row : rows_) {
      table_.candela.insert(table_.candela.end(), row.begin(), row.end());
    }
  }

  /// 0 alone: alike all around. 0 to 90: symmetric in each quadrant. 0 to 180 and 90 to 270: on
  /// both sides of the plane of these. Else a whole turn, the first plane at its end or not.
  void checkHorizontal() {
    const double first = angles_.front();
    const double last = angles_.back();
    if (table_.type != PhotometryType::c) {
      return checkAhead("horizontal", first == 0 ? -last : first, last);
    }
    if (first == 0 && (last == 90 || last == 180)) {
      mirrors_ = last == 90 ? std::vector<double>{90, 0} : std::vector<double>{0};
    } else if (first == 90 && last == 270) {
      mirrors_ = {90};
    } else if (first != 0 || (last > 0 && (last < 180 || 360 - last > widestStep(angles_)))) {
      cursor_.fail(
          fmt::format("horizontal angles from {} to {}; they are 0 alone, or go from 0 to 90, 0 to "
                      "180, 90 to 270 or 0 to 360",
                      first, last));
    }
  }

  void fill() {
    if (table_.type != PhotometryType::c) return fillAhead();
    if (angles_.back() == 0 || angles_.back() == 360) return asTheyAre();
    PlaneCircle circle;
    for (std::size_t k = 0; k < angles_.size(); ++k) circle.add(angles_[k], std::move(rows_[k]));
    for (const double plane : mirrors_) circle.mirror(plane);
    circle.fill(table_);
  }

  std::string file_;
  std::string text_;
  MeshCursor cursor_;
  Photometry table_;
  bool has_version_ = false;
  bool is_2019_ = false;  ///< in which the number after the ballast factor tells how it was made
  double factor_ = 1;
  std::size_t vertical_count_ = 0;
  std::size_t horizontal_count_ = 0;
  std::vector<double> angles_;   ///< horizontal ones, as they stand there
  std::vector<double> mirrors_;  ///< planes of symmetry
  std::vector<std::vector<float>> rows_;
};

}  // namespace

Photometry readIes(const std::string& file, std::string_view content) {
  return checkedTable(file, IesReader(file, content).read());
}

}  // namespace radiosity
