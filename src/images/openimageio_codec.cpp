// The one place that knows OpenImageIO.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <memory>

#include "base/image_codec.h"

namespace radiosity {

namespace {

OIIO::ImageSpec readingHints() {
  // Colours as they are stored: not multiplied by an alpha that has no meaning here.
  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);
  return hints;
}

DecodedImage samplesOf(OIIO::ImageInput& input) {
  const OIIO::ImageSpec& spec = input.spec();
  DecodedImage image;
  image.opened = true;
  image.width = spec.width;
  image.height = spec.height;
  image.channels = spec.nchannels;
  image.floating = spec.format.is_floating_point();
  image.linear = OIIO::Strutil::iequals(spec.get_string_attribute("oiio:ColorSpace"), "linear");
  image.multiplied = spec.get_int_attribute("oiio:UnassociatedAlpha") == 0;
  image.quantity = spec.get_string_attribute("quantity");
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1) {
    image.problem = "it holds no pixels";
    return image;
  }
  image.samples.resize(std::size_t(spec.width) * std::size_t(spec.height) *
                       std::size_t(spec.nchannels));
  if (!input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.samples.data())) {
    image.problem = input.geterror();
  }
  return image;
}

DecodedImage unopened(std::string problem) {
  DecodedImage image;
  image.problem = std::move(problem);
  return image;
}

class OpenImageIoCodec final : public ImageCodec {
 public:
  DecodedImage read(const std::string& path) const override {
    const OIIO::ImageSpec hints = readingHints();
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, &hints);
    return input ? samplesOf(*input) : unopened(OIIO::geterror());
  }

  DecodedImage decode(const std::string& name, const std::string& format,
                      std::span<const unsigned char> bytes) const override {
    OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
    OIIO::Filesystem::IOProxy* proxy = &memory;
    OIIO::ImageSpec hints = readingHints();
    hints.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, static_cast<const void*>(&proxy));
    // By the format's name: given a file's name, OpenImageIO 2.4 looks for that file first.
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(format);
    if (!input) return unopened(OIIO::geterror());
    OIIO::ImageSpec spec;
    return input->open(name, spec, hints) ? samplesOf(*input) : unopened(input->geterror());
  }

  EncodedImage encode(const std::string& path, const ImageToEncode& image) const override {
    OIIO::ImageSpec spec(image.width, image.height, 4,
                         image.floating ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
    spec.channelnames = {"R", "G", "B", "A"};
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
    } else if (!output->open(path, spec) || !output->write_image(spec.format, image.pixels) ||
               !output->close()) {
      file.problem = output->geterror();
    }
    return file;
  }
};

}  // namespace

/// What imageCodec() asks this library for.
extern "C" const ImageCodec* radiosityImageCodec() {
  static const OpenImageIoCodec kCodec;
  return &kCodec;
}

}  // namespace radiosity
