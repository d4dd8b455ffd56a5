// How a lamp spreads its light: the table of an IES LM-63 or EULUMDAT file.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "radiosity/base.h"

namespace [[gnu::visibility("default")]] radiosity {

/// How angles are counted (LM-63-2002; CIE 121). The lamp's frame has z along the direction of
/// angles 0, 0, at which the lamp is aimed.
///   c  vertical: off z, 0 to 180; horizontal: about z, from x (C0) to y (C90), 0 to 360
///   b  vertical: about x, from z to y; horizontal: out of the plane of y and z, to x
///   a  horizontal: about y, from z to x; vertical: out of the plane of x and z, to y
/// With z down, y north and x east, horizontal angles of c go counter-clockwise seen from above;
/// those of a and b, with z ahead and y up, go to the right.
enum class PhotometryType { c, b, a };

/// A distribution of luminous intensity.
struct Photometry {
  PhotometryType type = PhotometryType::c;
  std::vector<double> vertical;    ///< V >= 2 angles, degrees, ascending; beyond them it is dark
  std::vector<double> horizontal;  ///< H angles, the whole range; one of 0: alike all around z
  std::vector<float> candela;      ///< H * V, row-major: a half-plane a row
  Vec3 opening{0.0};               ///< metres along x, y, z, about the lamp's place; luminous alike
  bool round = false;              ///< an ellipse in x and y instead of a rectangle
  double lamps = 0;   ///< lm, what the bare lamps give, as the file states; 0: it does not
  double stated = 0;  ///< lm, what leaves the luminaire, as the file states; 0: it does not
  std::vector<std::string> notes;  ///< of the reader, a line each; not a part of the text

  /// cd in a direction of the lamp's frame, of any length: bilinear in the angles.
  double intensity(const Vec3& direction) const;
  /// lm: the integral of intensity() over all directions. Exact but for rounding: the table is a
  /// sum of products of hats, and each hat times sine or cosine has a closed form.
  double flux() const;
  /// metres: the longest way across the opening; 0: it is a point.
  double size() const;
  /// What a user should know of it, a line each: notes, and a flux() that is not what is stated.
  std::vector<std::string> remarks() const;
  /// Throws InputError unless angles ascend within their range, numbers are finite, intensities are
  /// 0 or more and some are above it.
  void validate() const;

  /// The table, without blanks, commas, semicolons and signs of equality, for files and keys.
  std::string text() const;
  /// The inverse. Errors: InputError.
  static Photometry ofText(std::string_view text);
  bool operator==(const Photometry& other) const;
};

/// A file of a lamp. Errors: InputError naming file, line or value, and the cure.
///   .ies  IES LM-63 1986, 1991, 1995, 2002, 2019
///   .ldt  EULUMDAT
Photometry readPhotometry(const std::string& path);

/// The file of a lamp as a parameter of it (option_line.h). It is read at once; then it is a table
/// with a name, and needs the file no more.
class LampFile {
 public:
  LampFile() = default;
  /// `name`: of the file, without its folder.
  LampFile(std::string name, Photometry table);

  const std::string& name() const { return name_; }
  bool empty() const { return !table_; }
  /// Of one that is not empty.
  const Photometry& table() const { return *table_; }
  double flux() const { return flux_; }

  /// "NAME|TABLE", the name as of lights (light.h); empty if it is.
  std::string optionText() const;
  /// Takes such a text, or the path of a file, which is read. Errors: InputError.
  bool readOption(std::string_view text);
  bool operator==(const LampFile& other) const;

 private:
  std::string name_;
  std::shared_ptr<const Photometry> table_;
  double flux_ = 0;
};

}  // namespace radiosity
