#include "cli/picture.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

#include "cli/words.h"

namespace radiosity::cli {

namespace {

Camera namedCamera(const Request& request, const Scene& scene, std::string& from) {
  std::vector<std::string> names;
  for (const Camera& camera : scene.cameras) {
    if (camera.name == request.camera) {
      from = fmt::format("'{}' of the scene", camera.name);
      return camera;
    }
    names.push_back(camera.name);
  }
  if (request.camera.find('=') != std::string::npos) {
    from = "--camera";
    return parseCamera(request.camera);
  }
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  throw InputError(fmt::format(
      "--camera: the scene has no camera '{}'{}; it has {}; or write 'eye=X,Y,Z;target=X,Y,Z'",
      request.camera, suggestion(request.camera, names), list.empty() ? "none" : list));
}

int otherSide(double pixels) { return std::max(1, int(std::lround(pixels))); }

std::optional<double> exposureNumber(const Request& request) {
  if (request.exposure == "auto") return std::nullopt;
  std::string_view text = request.exposure;
  if (text.starts_with('+')) text.remove_prefix(1);
  double ev = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), ev);
  constexpr double kLargest = 100;  // 2^100 is beyond any lamp
  if (error != std::errc() || end != text.data() + text.size() || !(std::abs(ev) <= kLargest)) {
    throw InputError(
        fmt::format("--exposure: '{}' is neither auto nor a number of stops from -100 "
                    "to 100, e.g. --exposure 2.5",
                    request.exposure));
  }
  return ev;
}

}  // namespace

Picture choosePicture(const Request& request, const Scene& scene) {
  exposureNumber(request);
  Picture picture;
  picture.options = request.renderOptions();
  if (!request.camera.empty()) {
    picture.camera = namedCamera(request, scene, picture.camera_from);
  } else if (!scene.cameras.empty()) {
    picture.camera = scene.cameras.front();
    picture.camera_from = fmt::format("'{}', the scene's first", picture.camera.name);
  }
  const double aspect = picture.camera.aspect > 0 ? picture.camera.aspect : 1;
  RenderOptions& o = picture.options;
  if (!request.height) o.height = otherSide(o.width / aspect);
  if (!request.width && request.height) o.width = otherSide(o.height * aspect);
  o.validate();
  return picture;
}

void framePicture(Picture& picture, Pipeline& pipeline) {
  if (!picture.camera_from.empty()) return;
  const bool closed = pipeline.formFactors().report.closed;
  picture.camera = framingCamera(pipeline.patches(), closed,
                                 double(picture.options.width) / double(picture.options.height));
  picture.camera_from =
      closed ? "framed from inside the closed scene" : "framed from outside the open scene";
}

Image radiancePicture(const Picture& picture, Pipeline& pipeline, Session& session) {
  std::vector<double> radiance = pipeline.solved().radiosity;
  for (double& value : radiance) value *= std::numbers::inv_pi;
  return render(pipeline.patches(), radiance, picture.camera, picture.options, session.progress);
}

double exposureOf(const Request& request, const Image& radiance) {
  const std::optional<double> ev = exposureNumber(request);
  return ev ? *ev : autoExposure(radiance);
}

}  // namespace radiosity::cli
