// The only file that uses OpenImageIO.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <memory>

#include "base/image_codec.h"
#include "images/image_format.h"

namespace radiosity {

namespace {

OIIO::ImageSpec readingHints() {
  // We read colours as stored, not multiplied by alpha, which has no meaning here.
  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);
  return hints;
}

/// The channels of a pixel that are read: red, green, blue and alpha.
constexpr int kMostChannels = 4;

DecodedImage unopened(std::string problem) {
  DecodedImage image;
  image.problem = std::move(problem);
  return image;
}

/// The reason why an image of this size is refused; empty if it is not. Channels beyond four count
/// as additional pixels: a reader holds all channels for a moment.
std::string tooLarge(double width, double height, double channels, const ImageLimit& most) {
  if (width * height * std::max(channels / kMostChannels, 1.0) <= most.pixels) return {};
  return OIIO::Strutil::fmt::format(
      "has {:.0f} x {:.0f} pixels, {} allows {:g} million; make it smaller or allow more", width,
      height, most.option, most.pixels / 1e6);
}

DecodedImage samplesOf(OIIO::ImageInput& input, const ImageLimit& most) {
  const OIIO::ImageSpec& spec = input.spec();
  DecodedImage image;
  image.opened = true;
  image.width = spec.width;
  image.height = spec.height;
  image.channels = std::min(spec.nchannels, kMostChannels);
  // What follows the colours need not be alpha: depth, normals, another layer.
  const bool counts_alpha = image.channels == 2 || image.channels == kMostChannels;
  if (counts_alpha && spec.alpha_channel != image.channels - 1) --image.channels;
  image.floating = spec.format.is_floating_point();
  image.linear = OIIO::Strutil::iequals(spec.get_string_attribute("oiio:ColorSpace"), "linear");
  image.multiplied = spec.get_int_attribute("oiio:UnassociatedAlpha") == 0;
  image.quantity = spec.get_string_attribute("quantity");
  // Radiance's own format has nothing else.
  if (std::string_view(input.format_name()) == "hdr") image.quantity = "radiance";
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1 || spec.depth > 1) {
    image.problem = "it holds no picture";
    return image;
  }
  image.too_large = tooLarge(spec.width, spec.height, spec.nchannels, most);
  if (!image.too_large.empty()) return image;
  image.samples.resize(std::size_t(image.width) * std::size_t(image.height) *
                       std::size_t(image.channels));
  if (!input.read_image(0, 0, 0, image.channels, OIIO::TypeDesc::FLOAT, image.samples.data())) {
    image.problem = input.geterror();
  }
  return image;
}

/// Silences standard error while it lives: libpng writes errors there before OpenImageIO stops it,
/// and we get the same text as the reason anyway.
class QuietErrors {
 public:
  QuietErrors() : saved_(dup(STDERR_FILENO)) {
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0) return;
    std::fflush(stderr);
    dup2(nowhere, STDERR_FILENO);
    ::close(nowhere);
  }
  ~QuietErrors() {
    if (saved_ < 0) return;
    std::fflush(stderr);
    dup2(saved_, STDERR_FILENO);
    ::close(saved_);
  }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;

 private:
  int saved_;
};

using Bytes = std::span<const unsigned char>;

/// Opens the image named `name` with `hints` if its format and size are accepted.
DecodedImage decodeChecked(const std::string& name, Bytes start, const ImageLimit& most,
                           const OIIO::ImageSpec& hints) {
  const std::string format = imageFormatOf(start, name);
  if (format.empty()) return unopened("of an unknown image format");
  if (const auto size = imageSizeOf(start, format)) {
    DecodedImage image;
    image.opened = true;
    image.too_large = tooLarge(double(size->first), double(size->second), 1, most);
    if (!image.too_large.empty()) return image;
  }
  // We ask for the format by name: given a file's name, OpenImageIO 2.4 tries all its formats, and
  // some of them unpack everything at once.
  const QuietErrors quiet;
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(format);
  if (!input) return unopened(OIIO::geterror());
  OIIO::ImageSpec spec;
  return input->open(name, spec, hints) ? samplesOf(*input, most) : unopened(input->geterror());
}

class OpenImageIoCodec final : public ImageCodec {
 public:
  DecodedImage read(const std::string& path, const ImageLimit& most) const override {
    std::array<unsigned char, kImageHeaderBytes> start{};
    std::ifstream file(path, std::ios::binary);
    file.read(reinterpret_cast<char*>(start.data()), start.size());
    return decodeChecked(path, Bytes(start).first(std::size_t(file.gcount())), most,
                         readingHints());
  }

  DecodedImage decode(const std::string& name, Bytes bytes, const ImageLimit& most) const override {
    OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
    OIIO::Filesystem::IOProxy* proxy = &memory;
    OIIO::ImageSpec hints = readingHints();
    hints.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, static_cast<const void*>(&proxy));
    return decodeChecked(name, bytes.first(std::min(bytes.size(), kImageHeaderBytes)), most, hints);
  }

  /// Whether encoded bytes can be read again. OpenEXR leaves out lines for which it finds no
  /// memory, and says nothing.
  static bool isWhole(const std::string& path, const ImageToEncode& image,
                      const std::vector<unsigned char>& bytes) {
    OIIO::Filesystem::IOMemReader memory(const_cast<unsigned char*>(bytes.data()), bytes.size());
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, nullptr, &memory);
    const std::size_t channels = image.channels.size();
    std::vector<float> samples(std::size_t(image.width) * std::size_t(image.height) * channels);
    return input &&
           input->read_image(0, 0, 0, int(channels), OIIO::TypeDesc::FLOAT, samples.data());
  }

  EncodedImage encode(const std::string& path, const ImageToEncode& image) const override {
    OIIO::ImageSpec spec(image.width, image.height, int(image.channels.size()),
                         image.floating ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
    spec.channelnames = image.channels;
    spec.alpha_channel = 3;
    spec.attribute("oiio:ColorSpace", image.colour_space);
    if (image.floating) spec.attribute("compression", "zip");
    if (!image.multiplied) spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("Software", "radiosity");
    for (const auto& [name, value] : image.metadata) spec.attribute(name, value);
    EncodedImage file;
    OIIO::Filesystem::IOVecOutput memory(file.bytes);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(path, &memory);
    if (!output) {
      file.problem = OIIO::geterror();
      return file;
    }
    const bool written = output->open(path, spec) &&
                         output->write_image(spec.format, image.pixels) && output->close();
    file.problem = output->geterror();
    if (file.problem.empty() && !(written && isWhole(path, image, file.bytes))) {
      file.problem = "pixels were left out; is there too little memory?";
    }
    return file;
  }
};

}  // namespace

/// The entry point by which imageCodec() finds the codec of this library.
extern "C" [[gnu::visibility("default")]] const ImageCodec* radiosityImageCodec() {
  static const OpenImageIoCodec kCodec;
  return &kCodec;
}

}  // namespace radiosity
