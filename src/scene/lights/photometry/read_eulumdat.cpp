// EULUMDAT (A. W. Stockmar, "EULUMDAT/2 - extended version of a well established luminaire data
// format", CIBSE National Lighting Conference 1998): a value a line, by the line's number.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "base/parse.h"
#include "base/printable.h"
#include "scene/lights/photometry/plane_circle.h"
#include "scene/lights/photometry/readers.h"
#include "scene/text.h"

namespace radiosity {

namespace {

constexpr double kMetresPerMillimetre = 1e-3;

class EulumdatReader {
 public:
  EulumdatReader(const std::string& file, std::string_view content)
      : file_(file), lines_(splitAt(content, '\n')) {
    constexpr char kEndOfDosText = 0x1a;
    if (lines_.back().starts_with(kEndOfDosText)) lines_.pop_back();
    while (!lines_.empty() && trimmed(lines_.back()).empty()) lines_.pop_back();
  }

  Photometry read() {
    const std::size_t symmetry = whole(3, "the symmetry", 0, 4);
    const std::size_t planes = whole(4, "the number of C-planes", 1, kMostLines);
    const std::size_t angles = whole(6, "the number of intensities a plane", 2, kMostLines);
    readOpening();
    const double per_lumen = readLamps();
    constexpr std::size_t kRatios = 10;  // of rooms; not used
    at_ += kRatios;
    const std::size_t rows = rowsOf(symmetry, planes);
    requireLines(planes, angles, rows);
    const std::vector<double> around = readAngles("C", planes);
    table_.vertical = readAngles("gamma", angles);
    const double first = table_.vertical.front();
    const double last = table_.vertical.back();
    if (!isVerticalRange(first, last)) {
      fail(at_, fmt::format("gamma angles from {} to {}; {}", first, last, kVerticalRanges));
    }
    fill(symmetry, around, rows, per_lumen);
    return std::move(table_);
  }

 private:
  static constexpr std::size_t kMostLines = std::numeric_limits<std::uint32_t>::max();

  [[noreturn]] void fail(std::size_t line, const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", file_, line, what));
  }

  /// Lines count from 1, as the format's description does.
  std::string_view line(std::size_t number, const char* what) const {
    if (number <= lines_.size()) return trimmed(lines_[number - 1]);
    fail(lines_.size(),
         fmt::format("the file ends before {}, line {}; export it again", what, number));
  }

  /// A comma may stand for the point.
  double number(std::size_t at, const char* what, bool may_lack = false) const {
    const std::string_view text = line(at, what);
    if (may_lack && text.empty()) return 0;
    std::string word(text);
    std::ranges::replace(word, ',', '.');
    const std::optional<double> value = parseNumber(word);
    if (value) return *value;
    fail(at, fmt::format("{} `{}` is not a finite number; correct it, or export it again", what,
                         printable(text.substr(0, 40))));
  }

  std::size_t whole(std::size_t at, const char* what, std::size_t least, std::size_t most) const {
    const double value = number(at, what);
    if (value == std::floor(value) && value >= double(least) && value <= double(most)) {
      return std::size_t(value);
    }
    fail(at, most == kMostLines
                 ? fmt::format("{} is {}; give a whole number from {}", what, value, least)
                 : fmt::format("{} is {}; it is {} to {}", what, value, least, most));
  }

  /// C0 looks across the length of a luminaire, C90 along it (DIAL, "Luminous intensity
  /// distribution", of DIALux 4). Without a width it is round. Sides of several heights count as
  /// their mean.
  void readOpening() {
    const auto metres = [this](std::size_t at, const char* what) {
      const double size = kMetresPerMillimetre * number(at, what, true);
      if (size < 0) fail(at, fmt::format("{} is below 0; correct it", what));
      return size;
    };
    const double length = metres(16, "the length of the luminous area");
    const double width = metres(17, "the width of the luminous area");
    double height = 0;
    for (std::size_t side = 0; side < 4; ++side) {
      height += metres(18 + side, "the height of the luminous area") / 4;
    }
    table_.round = width == 0 && length > 0;
    table_.opening = {table_.round ? length : width, length, height};
  }

  /// Returns cd over the file's unit, cd for 1000 lm of all lamps. A negative number of lamps says
  /// that the lumens are the luminaire's (absolute photometry), and changes nothing else.
  double readLamps() {
    const double ratio = number(23, "the light output ratio", true);
    const double conversion = number(24, "the conversion factor");
    if (!(conversion > 0)) fail(24, "the conversion factor is not above 0; write 1");
    const double tilt = number(25, "the tilt in measurement", true);
    if (tilt != 0) {
      table_.notes.push_back(fmt::format(
          "it was tilted by {} degrees when measured; its angles are taken as they are", tilt));
    }
    const std::size_t sets = whole(26, "the number of sets of lamps", 1, kMostLines);
    constexpr std::size_t kLinesOfSet = 6;
    constexpr std::size_t kFluxInSet = 3;
    at_ = 26;
    double lumens = 0;
    for (std::size_t k = 0; k < sets; ++k, at_ += kLinesOfSet) {
      number(at_ + 1, "the number of lamps");
      const double flux = number(at_ + kFluxInSet, "the lumens of the lamps");
      if (!(flux > 0))
        fail(at_ + kFluxInSet, "the lumens of the lamps are not above 0; correct it");
      lumens += flux;
    }
    if (sets > 1) {
      table_.notes.push_back(fmt::format("its {} sets of lamps are all lit", sets));
    }
    table_.lamps = lumens;
    table_.stated = ratio > 0 ? lumens * ratio / 100 : 0;
    return conversion * lumens / 1000;
  }

  std::size_t rowsOf(std::size_t symmetry, std::size_t planes) const {
    constexpr std::size_t kParts[] = {1, 0, 2, 2, 4};
    if (symmetry == 1) return 1;
    if (symmetry == 0) return planes;
    const std::size_t parts = symmetry == 3 ? 4 : kParts[symmetry];
    if (planes % parts != 0) {
      fail(4, fmt::format("{} C-planes with the symmetry {}; their number is a multiple of {}",
                          planes, symmetry, parts));
    }
    return planes / kParts[symmetry] + 1;
  }

  /// Before anything of the given size is kept.
  void requireLines(std::size_t planes, std::size_t angles, std::size_t rows) const {
    const std::size_t needed = at_ + planes + angles;
    const bool fits = needed <= lines_.size() && rows <= lines_.size() && angles <= lines_.size() &&
                      needed + rows * angles <= lines_.size();
    if (!fits) {
      fail(lines_.size(),
           fmt::format(
               "the file ends here, and {} C-planes, {} gamma angles and {} x {} intensities "
               "take more lines; export it again",
               planes, angles, rows, angles));
    }
    if (needed + rows * angles < lines_.size()) {
      fail(needed + rows * angles + 1,
           fmt::format("more lines than {} x {} intensities take; export it again", rows, angles));
    }
  }

  std::vector<double> readAngles(const char* what, std::size_t count) {
    const std::string named = fmt::format("{} angle", what);
    std::vector<double> angles;
    for (std::size_t k = 0; k < count; ++k) {
      const double angle = number(++at_, named.c_str());
      if (k > 0 && !(angle > angles.back())) {
        fail(at_, fmt::format("{} {} follows {}; angles ascend, none is there twice", named, angle,
                              angles.back()));
      }
      if (angle < 0 || angle > 360) fail(at_, fmt::format("{} is {}; correct it", named, angle));
      angles.push_back(angle);
    }
    return angles;
  }

  std::vector<float> readRow(double factor) {
    const auto refuse = [this](const char* what, double value) {
      fail(at_, fmt::format("{}, {} cd; correct it", what, value));
    };
    std::vector<float> row;
    for (std::size_t k = 0; k < table_.vertical.size(); ++k) {
      row.push_back(candelaOf(factor * number(++at_, "intensity"), refuse));
    }
    return row;
  }

  /// 1: alike all around. 2: C0 to C180 are there, 3: C270 over C0 to C90, 4: C0 to C90; the rest
  /// is their mirror image.
  void fill(std::size_t symmetry, const std::vector<double>& around, std::size_t rows,
            double factor) {
    if (symmetry == 1) {
      table_.horizontal = {0};
      table_.candela = readRow(factor);
      return;
    }
    const std::size_t first = symmetry == 3 ? around.size() / 4 * 3 : 0;
    requirePlanes(symmetry, around, first, rows);
    PlaneCircle circle;
    for (std::size_t k = 0; k < rows; ++k) {
      std::vector<float> row = readRow(factor);
      // Some files have the first plane at the end, too.
      if (k > 0 && around[k % around.size()] == 360) continue;
      circle.add(around[(first + k) % around.size()], std::move(row));
    }
    if (symmetry == 3 || symmetry == 4) circle.mirror(90);
    if (symmetry == 2 || symmetry == 4) circle.mirror(0);
    circle.fill(table_);
  }

  void requirePlanes(std::size_t symmetry, const std::vector<double>& around, std::size_t first,
                     std::size_t rows) const {
    constexpr double kFrom[] = {0, 0, 0, 270, 0};
    constexpr double kTo[] = {360, 360, 180, 90, 90};
    const double from = around[first];
    double to = around[(first + rows - 1) % around.size()];
    if (symmetry == 0 && kTo[0] - to <= widestStep(around)) to = kTo[0];
    if (from == kFrom[symmetry] && to == kTo[symmetry]) return;
    fail(at_,
         fmt::format("intensities from C{} to C{} with the symmetry {}; they go from C{} to C{}",
                     from, to, symmetry, kFrom[symmetry], kTo[symmetry]));
  }

  std::string file_;
  std::vector<std::string_view> lines_;
  Photometry table_;
  std::size_t at_ = 0;  ///< the line read last, from 1
};

}  // namespace

Photometry readEulumdat(const std::string& file, std::string_view content) {
  return checkedTable(file, EulumdatReader(file, content).read());
}

}  // namespace radiosity
