#include "cli/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>
#include <utility>

#include "cli/words.h"
#include "radiosity/results.h"
#include "radiosity/version.h"

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
    return parseCamera(request.camera, scene.up);
  }
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  throw InputError(fmt::format(
      "--camera: the scene has no camera '{}'{}; it has {}; or write 'eye=X,Y,Z;target=X,Y,Z'",
      request.camera, suggestion(request.camera, names), list.empty() ? "none" : list));
}

int otherSide(double pixels) { return std::max(1, int(std::lround(pixels))); }

}  // namespace

Picture choosePicture(const Request& request, const Scene& scene) {
  Picture picture;
  picture.options = request.renderOptions();
  picture.up = scene.up;
  if (!request.camera.empty()) {
    picture.camera = namedCamera(request, scene, picture.camera_from);
  } else if (!scene.cameras.empty()) {
    picture.camera = scene.cameras.front();
    picture.camera_from = fmt::format("'{}', the scene's first", picture.camera.name);
  }
  const double aspect = picture.camera.aspect > 0 ? picture.camera.aspect : 1;
  RenderOptions& o = picture.options;
  const bool by_height = request.given.has("height");
  if (!by_height) o.height = otherSide(o.width / aspect);
  if (by_height && !request.given.has("width")) o.width = otherSide(o.height * aspect);
  o.validate();
  return picture;
}

void framePicture(Picture& picture, const PatchMesh& mesh, bool closed,
                  std::span<const double> reflected) {
  if (!picture.camera_from.empty()) return;
  picture.camera =
      framingCamera(mesh, closed, double(picture.options.width) / double(picture.options.height),
                    reflected, picture.up);
  picture.camera_from = picture.camera.name;
}

void requireColours(const Pipeline& pipeline, const Request& request, const OutputSet& files) {
  const int bands = pipeline.bands();
  if (bands == 1 || bands == 3) return;
  for (const Format format : {Format::png, Format::exr, Format::hdr, Format::glb, Format::page}) {
    if (!files.has(format)) continue;
    throw InputError(fmt::format(
        "{}: draws three bands (red, green, blue), or one in grey, and {} has {}; keep the numbers "
        "(-o FILE.h5), or draw their sum: radiosity render {} --show radiosity -o FILE.png",
        files.path(format), request.input, bands, request.input));
  }
}

namespace {

/// The digits with which the camera's places can be given again, also far from the origin: to about
/// 1e-6 of the distance that it looks at.
int placeDigits(const Camera& camera) {
  const Vec3 farthest = glm::max(glm::abs(camera.eye), glm::abs(camera.target));
  const double size = std::max({farthest.x, farthest.y, farthest.z});
  const double distance = glm::distance(camera.eye, camera.target);
  if (!(distance > 0)) return 6;
  return 6 + int(std::clamp(std::ceil(std::log10(size / distance)), 0.0, 10.0));
}

}  // namespace

void reportPicture(Report& report, const Picture& picture) {
  const Camera& c = picture.camera;
  const double eye[] = {c.eye.x, c.eye.y, c.eye.z};
  const double target[] = {c.target.x, c.target.y, c.target.z};
  const double up[] = {c.up.x, c.up.y, c.up.z};
  report.section("picture", "Picture");
  report.text("camera", "camera", picture.camera_from);
  const int digits = placeDigits(c);
  report.bands("eye_m", "eye", eye, "m", digits);
  report.bands("target_m", "target", target, "m", digits);
  report.bands("up", "up", up, "");
  report.number("vertical_fov_deg", "vertical field of view", degrees(c.vertical_fov), "deg");
  report.text(
      "size", "size",
      fmt::format("{} x {} pixels, {} x {} samples", picture.options.width, picture.options.height,
                  picture.options.samples, picture.options.samples));
}

Metadata metadataOf(const Picture& picture, const std::string& quantity, const std::string& unit) {
  return {{"Software", "radiosity " RADIOSITY_VERSION},
          {"quantity", quantity},
          {"unit", unit},
          {"camera", cameraText(picture.camera)}};
}

void writeLitMesh(Report& report, const PatchMesh& mesh, const SurfaceLight& light,
                  OutputSet& files, double ev, double crease) {
  std::size_t triangles = 0;
  files.write(Format::glb,
              fmt::format("lit mesh of {}, EV {:.2f}", light.elements ? "elements" : "patches", ev),
              [&](const std::string& temporary) {
                triangles = writeLitGlb(temporary, mesh, light, ev, crease);
              });
  report.section("lit_mesh", "Lit mesh");
  report.count("triangles", "triangles", triangles);
}

namespace {

/// The camera as Radiance's pictures have it: full angles across and up, degrees.
std::string radianceView(const Picture& picture) {
  const Camera& c = picture.camera;
  const Vec3 ahead = glm::normalize(c.target - c.eye);
  const double ratio = double(picture.options.width) / double(picture.options.height);
  const double across = 2 * std::atan(std::tan(c.vertical_fov / 2) * ratio);
  return fmt::format("-vtv -vp {} {} {} -vd {} {} {} -vu {} {} {} -vh {} -vv {}", c.eye.x, c.eye.y,
                     c.eye.z, ahead.x, ahead.y, ahead.z, c.up.x, c.up.y, c.up.z, degrees(across),
                     degrees(c.vertical_fov));
}

/// Warns if the picture only shows dark parts, which automatic exposure would hide.
void warnOfDarkness(Report& report, const PatchMesh& mesh, const SurfaceLight& light,
                    const Image& radiance) {
  const std::optional<UnlitView> view = unlitView(mesh, light, radiance);
  if (!view) return;
  const Index i = view->brightest;
  const Vec3 place = mesh.centroid[i];
  const Note note{Severity::warning,
                  fmt::format("nothing lit is in view: what the camera sees has {:.2g} W/m^2/sr, "
                              "what is lit {:.2g}; point the camera at {}, with --camera "
                              "'eye=X,Y,Z;target={:.3g},{:.3g},{:.3g}'",
                              view->seen, view->lit, mesh.surface_names[mesh.surface[i]], place.x,
                              place.y, place.z)};
  report.notes({&note, 1});
}

}  // namespace

bool hasPicture(const OutputSet& files) {
  return files.has(Format::png) || files.has(Format::exr) || files.has(Format::hdr);
}

double writeLight(Session& session, const PatchMesh& mesh, const SurfaceLight& light,
                  const Image& radiance, const Picture& picture, OutputSet& files,
                  std::span<const ImageLayer> layers) {
  const double ev = exposureOf(session.request, mesh, light, radiance, picture);
  if (session.request.exposure == "auto") warnOfDarkness(session.report, mesh, light, radiance);
  session.report.number("exposure_ev", "exposure", ev,
                        session.request.exposure == "auto" ? "EV (automatic)" : "EV");
  files.write(Format::png, fmt::format("picture, EV {:.2f}, sRGB", ev),
              [&](const std::string& temporary) {
                Metadata metadata = metadataOf(picture, "exposed radiance", "sRGB");
                metadata.emplace_back("exposure_ev", fmt::format("{}", ev));
                writeImage(temporary, exposed(radiance, ev), false, metadata);
              });
  std::string names;
  for (const ImageLayer& layer : layers) names += (names.empty() ? "; layers " : ", ") + layer.name;
  files.write(Format::exr, "radiance, W/m^2/sr, linear" + names, [&](const std::string& temporary) {
    writeImage(temporary, radiance, false, metadataOf(picture, "radiance", "W/m^2/sr"), layers);
  });
  files.write(Format::hdr, "radiance, W/m^2/sr, RGBE", [&](const std::string& temporary) {
    Metadata metadata = metadataOf(picture, "radiance", "W/m^2/sr");
    metadata.emplace_back("VIEW", radianceView(picture));
    writeImage(temporary, radiance, false, metadata);
  });
  if (files.has(Format::glb) && session.request.lightmap.empty()) {
    writeLitMesh(session.report, mesh, light, files, ev, picture.options.crease);
  }
  return ev;
}

ExposedPicture exposePicture(Session& session, Pipeline& pipeline, const SurfaceLight& light) {
  Picture picture = choosePicture(session.request, pipeline.scene());
  const PatchMesh& mesh = pipeline.mesh().mesh;
  framePicture(picture, mesh, pipeline.factors().report.closed, light.reflected);
  const Image radiance =
      renderRadiance(mesh, light, picture.camera, picture.options, session.progress);
  const double ev = exposureOf(session.request, mesh, light, radiance, picture);
  return {std::move(picture), ev};
}

double exposureOf(const Request& request, const PatchMesh& mesh, const SurfaceLight& light,
                  const Image& radiance, const Picture& picture) {
  const std::optional<double> ev = request.exposureStops();
  if (ev) return *ev;
  return autoExposure(radiance, lampPixels(mesh, light, picture.camera, picture.options));
}

}  // namespace radiosity::cli
