// Image files as numbers. OpenImageIO reads and writes them. It brings 250 shared libraries of its
// own, which take a fifth of a second to load; so it is in a separate library (src/images), which
// is opened when the first image is read or written.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "radiosity/spelling.h"

namespace radiosity {

/// The samples of a file as stored, row by row from the top, the channels of a pixel together.
/// Integers are mapped to [0, 1]; no transfer function is inverted.
struct DecodedImage {
  int width = 0;
  int height = 0;
  int channels = 0;
  bool floating = false;    ///< stored as floating-point numbers
  bool linear = false;      ///< the file says that its numbers are linear
  bool multiplied = false;  ///< the colours are multiplied by alpha
  std::string quantity;     ///< the attribute of that name; "radiance" of .hdr; empty: none
  std::vector<float> samples;
  bool opened = false;    ///< false: no file of a known format
  std::string problem;    ///< why there are no samples, in OpenImageIO's words; else empty
  std::string too_large;  ///< "has W x H pixels, ...; cure" if the size alone is the reason
};

/// Channels as 32-bit floats or bytes, whichever the file's format takes.
struct ImageToEncode {
  int width = 0;
  int height = 0;
  /// Those of a pixel together, R, G, B, A first.
  std::vector<std::string> channels = {"R", "G", "B", "A"};
  bool floating = false;  ///< `pixels` are floats, else bytes
  const void* pixels = nullptr;
  bool multiplied = false;   ///< colours are multiplied by alpha
  std::string colour_space;  ///< "Linear" or "sRGB"
  std::span<const std::pair<std::string, std::string>> metadata;
};

/// The bytes of a file, or the `problem` if there are none.
struct EncodedImage {
  std::vector<unsigned char> bytes;
  std::string problem;
};

/// The largest image that is unpacked, and the option that says so.
struct ImageLimit {
  double pixels = 0;
  std::string option = spelled("max_image");
};

class ImageCodec {
 public:
  virtual ~ImageCodec() = default;
  /// Reads the first four channels of the regular file `path`; its first bytes tell the format. A
  /// larger image is not unpacked.
  virtual DecodedImage read(const std::string& path, const ImageLimit& most) const = 0;
  /// The same from memory; `name` is for messages.
  virtual DecodedImage decode(const std::string& name, std::span<const unsigned char> bytes,
                              const ImageLimit& most) const = 0;
  /// The format is that of the extension of `path`; nothing is written there.
  virtual EncodedImage encode(const std::string& path, const ImageToEncode& image) const = 0;
};

/// Opens the library at the first call. Errors: RunError if it is not beside this one or not
/// complete.
const ImageCodec& imageCodec();

}  // namespace radiosity
