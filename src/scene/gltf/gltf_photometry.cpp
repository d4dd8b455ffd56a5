#include "scene/gltf/gltf_photometry.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <iterator>
#include <numbers>

#include "base/base64.h"
#include "base/finite.h"
#include "scene/lights/light_text.h"
#include "scene/lights/photometry/readers.h"

namespace radiosity {

namespace {

/// The extension has infinitely small points, whatever opening a file gives.
LampFile pointOf(std::string name, Photometry table) {
  table.opening = Vec3(0.0);
  return {std::move(name), std::move(table)};
}

/// An embedded file has no name of its own.
LampFile embedded(const GltfFile& file, const std::string& name, std::string_view content) {
  return pointOf(name, readIes(fmt::format("{}: {}", file.path, name), content));
}

LampFile profileOf(const GltfFile& file, const tinygltf::Value& profile, const std::string& name) {
  const tinygltf::Value& view = memberOf(profile, "bufferView");
  if (view.IsInt()) {
    tinygltf::Image bytes;
    bytes.bufferView = view.GetNumberAsInt();
    const std::span<const unsigned char> content = file.imageBytes(bytes, name);
    return embedded(file, name, {reinterpret_cast<const char*>(content.data()), content.size()});
  }
  const tinygltf::Value& given = memberOf(profile, "uri");
  if (!given.IsString()) file.fail(name + " has neither uri nor bufferView; export it again");
  const std::string& uri = given.Get<std::string>();
  if (uri.starts_with("data:")) {
    const std::size_t begin = uri.find(";base64,");
    const std::optional<std::string> content =
        begin == uri.npos ? std::nullopt : ofBase64(std::string_view(uri).substr(begin + 8));
    if (!content) file.fail(name + " has data that is not base64; export it again");
    return embedded(file, name, *content);
  }
  const std::filesystem::path path =
      std::filesystem::path(file.path).parent_path() / decodedText(uri);
  return pointOf(path.filename().string(), readPhotometry(path.string()));
}

const tinygltf::Value& profilesOf(const GltfFile& file) {
  static const tinygltf::Value kNoProfiles;
  const auto extension = file.model.extensions.find(kGltfPhotometry);
  if (extension == file.model.extensions.end()) return kNoProfiles;
  return memberOf(extension->second, "lights");
}

/// The turn that brings a lamp's frame to that of a node, degrees. Its x lies in the plane of
/// horizontal angle 0: that of C0, and of the vertical angles of types A and B, whose y it is.
double turnTo(const PhotometricLight& lamp, const Vec3& x) {
  const auto& [x0, y0, z0] = lamp.axes();
  const bool of_c = lamp.file.table().type == PhotometryType::c;
  const double angle = of_c ? std::atan2(glm::dot(x, y0), glm::dot(x, x0))
                            : std::atan2(-glm::dot(x, x0), glm::dot(x, y0));
  return angle * 180 / std::numbers::pi;
}

/// Of a node's lamp: what its intensities are multiplied by, a band each.
std::vector<double> factorsOf(const GltfFile& file, const tinygltf::Value& given,
                              const std::string& what) {
  std::vector<double> factors(3, 1.0);
  if (given.Has("multiplier")) {
    const tinygltf::Value& multiplier = given.Get("multiplier");
    if (!multiplier.IsNumber() || !(multiplier.GetNumberAsDouble() >= 0)) {
      file.fail(what + ": multiplier of its lamp is no number of 0 or more; correct it");
    }
    factors.assign(factors.size(), multiplier.GetNumberAsDouble());
  }
  if (!given.Has("color")) return factors;
  const tinygltf::Value& colour = given.Get("color");
  const bool is_whole = colour.IsArray() && colour.ArrayLen() == factors.size();
  for (std::size_t band = 0; band < factors.size(); ++band) {
    const double share = is_whole && colour.Get(int(band)).IsNumber()
                             ? colour.Get(int(band)).GetNumberAsDouble()
                             : -1;
    if (!(share >= 0 && share <= 1)) {
      file.fail(what + ": color of its lamp is not three numbers from 0 to 1; correct it");
    }
    factors[band] *= share;
  }
  return factors;
}

}  // namespace

const LampFile& GltfLamps::profile(const tinygltf::Value& number, const std::string& what) {
  const tinygltf::Value& all = profilesOf(file_);
  if (!number.IsInt() || !all.IsArray() || number.GetNumberAsInt() < 0 ||
      std::size_t(number.GetNumberAsInt()) >= all.ArrayLen()) {
    file_.fail(what + ": its light profile does not exist; export the scene again");
  }
  const int index = number.GetNumberAsInt();
  LampFile& profile = profiles_[index];
  if (profile.empty()) {
    profile = profileOf(file_, all.Get(index), fmt::format("light profile {}", index));
  }
  return profile;
}

Light GltfLamps::read(const tinygltf::Node& node, const glm::dmat4& transform,
                      const std::string& what) {
  const tinygltf::Value& given = node.extensions.at(kGltfPhotometry);
  PhotometricLight lamp;
  lamp.file = profile(memberOf(given, "light"), what);
  const Vec3 forward(transform * glm::dvec4(0, 0, -1, 0));
  const Vec3 side(transform * glm::dvec4(1, 0, 0, 0));
  lamp.at = Vec3(transform[3]);
  if (!isFinite(lamp.at) || !isFinite(forward) || !isFinite(side) || !(glm::length(forward) > 0) ||
      !(glm::length(side) > 0)) {
    file_.fail(what + ": its lamp has no place and direction; correct its transform");
  }
  lamp.aim = lamp.at + glm::normalize(forward);
  lamp.settle(Up::y);
  lamp.turn = turnTo(lamp, glm::normalize(side));
  std::vector<double> strength = factorsOf(file_, given, what);
  for (double& flux : strength) flux *= lamp.usual();
  return {"", std::move(lamp), std::move(strength), true};
}

std::vector<std::string> GltfLamps::remarks() const {
  std::vector<std::string> all;
  for (const auto& [index, file] : profiles_) {
    PhotometricLight lamp;
    lamp.file = file;
    std::ranges::move(lamp.remarks(), std::back_inserter(all));
  }
  return all;
}

}  // namespace radiosity
