#include "scene/meshes/view3d_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/parse.h"
#include "scene/scene_builder.h"

namespace radiosity {

namespace {

using Kind = View3dSurface::Kind;

struct Token {
  std::string_view word;
  std::size_t line;
};

/// The words between blanks and commas; `!` comments out the rest of a line, `*` ends the data.
std::vector<Token> tokensOf(std::string_view text) {
  constexpr std::string_view kSeparators = " ,\t\r";
  std::vector<Token> tokens;
  std::size_t line = 1;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == '\n') {
      ++line;
      ++at;
    } else if (kSeparators.find(text[at]) != std::string_view::npos) {
      ++at;
    } else if (text[at] == '!') {
      at = std::min(text.find('\n', at), text.size());
    } else if (text[at] == '*') {
      break;
    } else {
      const std::size_t end = std::min(text.find_first_of(" ,\t\r\n", at), text.size());
      tokens.push_back({text.substr(at, end - at), line});
      at = end;
    }
  }
  return tokens;
}

char upper(char c) { return char(std::toupper(static_cast<unsigned char>(c))); }

/// Sine and cosine of an angle in degrees, exact if they are 0 or 1, so that walls meet.
struct Turn {
  double sine;
  double cosine;
};

Turn turnBy(double degrees) {
  int quarter = 0;
  const double rest = std::remquo(degrees, 90.0, &quarter) * std::numbers::pi / 180;
  const double s = std::sin(rest);
  const double c = std::cos(rest);
  switch (quarter & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

class View3dScanner {
 public:
  View3dScanner(const std::string& file, std::string_view text)
      : file_(file), tokens_(tokensOf(text)) {}

  View3dScan run() {
    while (at_ < tokens_.size() && statement()) skipLine();
    checkReferences();
    if (scan_.surfaces.empty()) {
      throw InputError(file_ + ": no surfaces (no S lines); write them as the View3D manual says");
    }
    notes_.appendTo(scan_.notes);
    return std::move(scan_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { failAt(line_, what); }
  [[noreturn]] void failAt(std::size_t line, const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", file_, line, what));
  }

  /// Reads a statement; false at the end of the data.
  bool statement();
  void skipLine() {
    while (at_ < tokens_.size() && tokens_[at_].line == line_) ++at_;
  }
  bool onThisLine() const { return at_ < tokens_.size() && tokens_[at_].line == line_; }
  std::string_view take(const char* what);
  double number(const char* what);
  std::size_t whole(const char* what);

  void control();
  void format();
  void vertex();
  void surface(char letter);
  void corners(View3dSurface& surface);
  void properties(View3dSurface& surface);
  void placedShape(View3dSurface& surface, char shape);
  void checkReferences() const;

  const std::string& file_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  std::size_t line_ = 0;
  enum class Format { unknown, vertices, placed } format_ = Format::unknown;
  View3dScan scan_;
  FeatureNotes notes_;
};

std::string_view View3dScanner::take(const char* what) {
  if (at_ == tokens_.size()) fail(fmt::format("the file ends where a {} belongs; add it", what));
  line_ = tokens_[at_].line;  // data may continue in the next line
  return tokens_[at_++].word;
}

double View3dScanner::number(const char* what) {
  const std::string_view word = take(what);
  const std::optional<double> value = parseNumber(word);
  if (!value) {
    fail(fmt::format("{} `{}` is not a finite number; write it as 1.5 with a decimal point", what,
                     word));
  }
  return *value;
}

std::size_t View3dScanner::whole(const char* what) {
  const std::string_view word = take(what);
  const std::optional<long long> value = parseInteger(word);
  if (!value || *value < 0) {
    fail(fmt::format("{} `{}` is not a whole number of 0 or more; correct it", what, word));
  }
  return std::size_t(*value);
}

bool View3dScanner::statement() {
  line_ = tokens_[at_].line;
  const std::string_view word = tokens_[at_++].word;
  const char letter = upper(word[0]);
  if (letter == 'E') return false;
  if (letter == '/' || letter == 'T') return true;
  if (word.size() == 1) {
    switch (letter) {
      case 'C':
        control();
        return true;
      case 'F':
        format();
        return true;
      case 'V':
        vertex();
        return true;
      case 'S':
      case 'M':
      case 'N':
      case 'O':
        surface(letter);
        return true;
      default:
        break;
    }
  }
  fail(fmt::format("`{}` begins no View3D line (T C F V S M N O E); correct or remove it", word));
}

/// Reads a control. It is not used: this program has options for it.
void View3dScanner::control() {
  while (onThisLine()) {
    notes_.add("View3D controls are not used (options of the program say these)",
               std::string(take("control")));
  }
}

void View3dScanner::format() {
  const std::string_view word = take("format");
  if (word == "3") {
    format_ = Format::vertices;
  } else if (word == "3a" || word == "3A") {
    format_ = Format::placed;
  } else {
    fail(fmt::format("F {} is not read; F 3 and F 3a describe surfaces in space", word));
  }
}

void View3dScanner::vertex() {
  const std::size_t given = whole("vertex number");
  if (given != scan_.vertices.size() + 1) {
    fail(fmt::format("vertex {} stands where vertex {} belongs; number them in order", given,
                     scan_.vertices.size() + 1));
  }
  if (given >= kNone) fail(fmt::format("more than {} vertices; split the scene", kNone));
  Vec3 place(0.0);
  for (int k = 0; k < 3; ++k) place[k] = number("coordinate");
  scan_.vertices.push_back(place);
}

void View3dScanner::surface(char letter) {
  if (format_ == Format::unknown) fail("no F line before the first surface; write F 3 above it");
  View3dSurface surface;
  surface.line = line_;
  surface.kind = letter == 'M'   ? Kind::mask
                 : letter == 'N' ? Kind::null
                 : letter == 'O' ? Kind::obstruction
                                 : Kind::radiating;
  const std::size_t number_here = scan_.surfaces.size() + 1;
  const std::size_t given = whole("surface number");
  if (given != number_here) {
    fail(fmt::format("surface {} stands where surface {} belongs; number them in order", given,
                     number_here));
  }
  // View3D reads nothing more of an obstruction, but such lines often were S lines before.
  const auto describe = [&] {
    if (surface.kind != Kind::obstruction || onThisLine()) properties(surface);
    if (surface.name.empty()) surface.name = fmt::format("obstruction {}", given);
    if (onThisLine()) {
      notes_.add("words behind the name of a surface are left out",
                 fmt::format("`{}` in line {}", tokens_[at_].word, line_), Severity::warning);
    }
    skipLine();
  };
  if (format_ == Format::vertices) {
    corners(surface);
    describe();
  } else {
    const std::string_view shape = take("shape");
    describe();
    placedShape(surface, shape.size() == 1 ? upper(shape[0]) : '?');
  }
  scan_.surfaces.push_back(std::move(surface));
}

void View3dScanner::corners(View3dSurface& surface) {
  for (int k = 0; k < 4; ++k) {
    const std::size_t v = whole("vertex number");
    if (v == 0 && k == 3) return;  // a triangle
    if (v == 0 || v > scan_.vertices.size()) {
      fail(
          fmt::format("vertex {} does not exist, there are {} before this line; correct the "
                      "surface",
                      v, scan_.vertices.size()));
    }
    surface.corners.push_back(Index(v - 1));
  }
}

void View3dScanner::properties(View3dSurface& surface) {
  surface.base = whole("base surface");
  surface.combined = whole("combined surface");
  surface.emissivity = number("emissivity");
  if (!(surface.emissivity >= 0 && surface.emissivity <= 1)) {
    fail(fmt::format("emissivity {} is outside 0 to 1; correct it", surface.emissivity));
  }
  if (surface.kind != Kind::obstruction || onThisLine()) surface.name = take("surface name");
}

/// Reads a shape in its own plane: seen from its front, x is to the right and y is up. The front
/// faces `azimuth` (clockwise from +y) and `tilt` (0 up, 90 level, 180 down).
void View3dScanner::placedShape(View3dSurface& surface, char shape) {
  Vec3 origin(0.0);
  for (int k = 0; k < 3; ++k) origin[k] = number("coordinate");
  const Turn azimuth = turnBy(number("azimuth"));
  const Turn tilt = turnBy(number("tilt"));
  const Vec3 right(-azimuth.cosine, azimuth.sine, 0.0);
  const Vec3 up(-azimuth.sine * tilt.cosine, -azimuth.cosine * tilt.cosine, tilt.sine);
  std::vector<Vec2> flat;
  if (shape == 'R') {
    const double width = number("width");
    const double height = number("height");
    flat = {{0, 0}, {width, 0}, {width, height}, {0, height}};
  } else if (shape == 'T' || shape == 'Q') {
    flat.resize(shape == 'T' ? 3 : 4);
    for (Vec2& corner : flat) {
      corner.x = number("coordinate");
      corner.y = number("coordinate");
    }
  } else {
    failAt(surface.line, "its shape is none of R, Q and T; correct it");
  }
  for (const Vec2& corner : flat) {
    surface.corners.push_back(Index(scan_.vertices.size()));
    scan_.vertices.push_back(origin + corner.x * right + corner.y * up);
  }
}

void View3dScanner::checkReferences() const {
  const std::vector<View3dSurface>& all = scan_.surfaces;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const View3dSurface& s = all[k];
    const bool covers = s.kind == Kind::mask || s.kind == Kind::null;
    for (const std::size_t other : {s.base, s.combined}) {
      if (other <= all.size()) continue;
      failAt(s.line,
             fmt::format("surface {} does not exist, there are {}; correct it", other, all.size()));
    }
    if (covers && s.base == 0) {
      failAt(s.line, "a mask or null surface covers a base surface; name it in the column base");
    }
    const bool base_later = s.base > k && all[s.base - 1].kind != Kind::obstruction;
    if (s.base == k + 1 || base_later) {
      failAt(s.line, fmt::format("its base surface {} does not come before it; renumber", s.base));
    }
    if (s.combined == 0) continue;
    if (s.combined > k) {
      failAt(s.line, fmt::format("surface {}, which it is combined with, does not come before it; "
                                 "renumber",
                                 s.combined));
    }
    const View3dSurface& whole_surface = all[s.combined - 1];
    if (covers || s.kind != whole_surface.kind) {
      failAt(s.line, fmt::format("it cannot be combined with surface {}, which is of another kind; "
                                 "set the column cmb to 0",
                                 s.combined));
    }
    if (whole_surface.combined != 0) {
      failAt(s.line,
             fmt::format("surface {} is itself combined with {}; combine both with that one",
                         s.combined, whole_surface.combined));
    }
    if (s.emissivity != whole_surface.emissivity) {
      failAt(s.line, fmt::format("its emissivity {} differs from {} of surface {}, which it is "
                                 "combined with; give both one, or do not combine them",
                                 s.emissivity, whole_surface.emissivity, s.combined));
    }
  }
}

}  // namespace

View3dScan scanView3d(const std::string& file, std::string_view text) {
  if (text.find('\0') != std::string_view::npos) {
    throw InputError(file + ": is not a text file; export it as View3D input");
  }
  return View3dScanner(file, text).run();
}

}  // namespace radiosity
