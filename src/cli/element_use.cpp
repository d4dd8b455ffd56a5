#include "cli/element_use.h"

#include <fmt/format.h>

#include "cli/picture.h"
#include "cli/show.h"

namespace radiosity::cli {

namespace {

/// Whether an output can be seen from anywhere and needs all elements; a picture only needs those
/// that it shows.
bool showsAllLight(const OutputSet& files) {
  return files.has(Format::glb) || files.has(Format::page);
}

bool drawsLight(const OutputSet& files) { return hasPicture(files) || showsAllLight(files); }

/// The reason why no output has elements, and the cure.
std::string whyNone(const Request& request, const OutputSet& files) {
  if (parseShow(request.show).quantity)
    return "--show " + request.show + " draws what patches have; leave one of the two out";
  if (request.flat) return "--flat draws one colour a patch; leave one of the two out";
  const std::string none = files.all().empty()
                               ? "nothing is written"
                               : files.all().front().path + " holds no light at points";
  return none + "; name a lit mesh (-o FILE.glb) or a results file (-o FILE.h5)";
}

const char* toleranceCure(const Request& request, const OutputSet& files) {
  if (request.elements) return "leave out --elements off";
  return files.has(Format::results) ? "add --elements on" : "leave it out";
}

/// Refuses --visible-only if it has no effect: a picture always has elements of visible surfaces
/// only.
void checkVisibleOnly(const Request& request, const ElementUse& use, const OutputSet& files) {
  if (!request.visible_only) return;
  const char* why = nullptr;
  if (!files.has(Format::glb)) {
    why = "it is about a lit mesh; name one with -o FILE.glb, or leave it out";
  } else if (!use.shown) {
    why = "no elements are evaluated here; leave one of the options out";
  } else if (!request.lightmap.empty()) {
    why = "a lightmap has light everywhere; leave one of the two out";
  } else if (request.elements.value_or(false) && files.has(Format::results)) {
    why = "a results file keeps elements of all patches; leave out --elements on";
  }
  if (why != nullptr) throw InputError(fmt::format("--visible-only: {}", why));
}

}  // namespace

ElementUse elementUse(const Request& request, const OutputSet& files) {
  const bool asked = request.elements.value_or(false);
  const bool of_light = !parseShow(request.show).quantity && !request.flat;
  ElementUse use;
  use.shown = request.elements.value_or(true) && of_light && drawsLight(files);
  use.all =
      of_light && ((use.shown && showsAllLight(files)) || (asked && files.has(Format::results)));
  checkVisibleOnly(request, use, files);
  if (request.visible_only) use.all = false;
  if (use.shown || use.all) return use;
  if (asked) throw InputError("--elements on: " + whyNone(request, files));
  if (request.given.has("element-tolerance")) {
    throw InputError(fmt::format("--element-tolerance: no elements are evaluated here; {}",
                                 toleranceCure(request, files)));
  }
  return use;
}

}  // namespace radiosity::cli
