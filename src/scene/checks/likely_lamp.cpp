// Suggests a surface that is probably a lamp.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "base/geometry/plane_frame.h"
#include "radiosity/scene.h"

namespace radiosity {

namespace {

constexpr std::array<std::string_view, 10> kLampWords = {
    "light",    "lamp",      "bulb",    "emit",       "emission",
    "emissive", "luminaire", "lantern", "chandelier", "neon"};
constexpr std::array<std::string_view, 2> kCeilingWords = {"ceiling", "ceil"};

/// The words of a name in lower case: "DeskLamp_02" gives desk, lamp.
std::vector<std::string> wordsOf(const std::string& name) {
  std::vector<std::string> words;
  bool inside = false;
  bool lower = false;
  for (const char c : name) {
    const auto letter = static_cast<unsigned char>(c);
    const bool begins = !inside || (lower && std::isupper(letter) != 0);
    inside = std::isalpha(letter) != 0;
    lower = std::islower(letter) != 0;
    if (!inside) continue;
    if (begins) words.emplace_back();
    words.back() += char(std::tolower(letter));
  }
  return words;
}

bool isOneOf(std::string_view word, std::span<const std::string_view> known) {
  return std::any_of(known.begin(), known.end(), [&](std::string_view k) {
    return word == k || (word.starts_with(k) && word.substr(k.size()) == "s") ||
           (k == "emit" && word.starts_with(k));
  });
}

/// Whether "light" at the end of these words is a shade: another material has the same name with
/// "dark", or without a shade ("metalLight" beside "metalDark" or "metal").
bool isShade(const Scene& scene, std::vector<std::string> words) {
  if (words.size() < 2 || words.back() != "light") return false;
  std::vector<std::string> plain(words.begin(), words.end() - 1);
  words.back() = "dark";
  return std::any_of(scene.materials.begin(), scene.materials.end(), [&](const Material& other) {
    const std::vector<std::string> of_other = wordsOf(other.name);
    return of_other == plain || of_other == words;
  });
}

/// 2: the name has a known word; 1: it has "light" before other words, where it may be a shade
/// ("light wood"); 0: neither.
int match(const Scene& scene, const std::string& name, std::span<const std::string_view> known) {
  const std::vector<std::string> words = wordsOf(name);
  if (isShade(scene, words)) return 0;
  int found = 0;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (!isOneOf(words[k], known)) continue;
    found = std::max(found, words[k] == "light" && k + 1 < words.size() ? 1 : 2);
  }
  return found;
}

/// The surface that matches best, by its material's name, which counts more, or by its own.
std::string bestMatch(const Scene& scene, std::span<const std::string_view> known) {
  int most = 0;
  std::string name;
  for (const Surface& surface : scene.surfaces) {
    const std::string& material = scene.materials[surface.material].name;
    const int of_material = 2 * match(scene, material, known);
    const int of_object = 2 * match(scene, surface.object, known) - 1;
    if (std::max(of_material, of_object) <= most) continue;
    most = std::max(of_material, of_object);
    name = of_material > of_object ? material : surface.name;
  }
  return name;
}

/// The surface with most area facing down, if most of its area faces down and it is in the upper
/// half of the scene: the underside of a table is not a ceiling.
std::string facingDown(const Scene& scene) {
  const auto up = scene.up == Up::z ? 2 : 1;
  std::vector<double> area(scene.surfaces.size(), 0.0);
  std::vector<double> down(scene.surfaces.size(), 0.0);
  std::vector<double> height(scene.surfaces.size(), 0.0);
  double low = HUGE_VAL;
  double high = -HUGE_VAL;
  for (std::size_t f = 0; f < scene.faceCount(); ++f) {
    const auto face = scene.face(f);
    const Vec3& first = scene.vertices[face[0]];
    const Vec3 sum = vectorArea(
        face.size(), [&](std::size_t k) -> const Vec3& { return scene.vertices[face[k]]; });
    for (const Index v : face) {
      low = std::min(low, scene.vertices[v][up]);
      high = std::max(high, scene.vertices[v][up]);
    }
    const Index s = scene.face_surface[f];
    area[s] += glm::length(sum);
    height[s] += glm::length(sum) * first[up];
    if (-sum[up] > 0.9 * glm::length(sum)) down[s] += -sum[up];
  }
  std::size_t best = scene.surfaces.size();
  for (std::size_t s = 0; s < area.size(); ++s) {
    const bool ceiling = down[s] > 0.5 * area[s] && height[s] > 0.5 * (low + high) * area[s];
    if (ceiling && (best == area.size() || down[s] > down[best])) best = s;
  }
  return best < area.size() ? scene.surfaces[best].name : std::string();
}

}  // namespace

std::string likelyLamp(const Scene& scene) {
  for (const auto& name :
       {bestMatch(scene, kLampWords), bestMatch(scene, kCeilingWords), facingDown(scene)}) {
    if (!name.empty()) return name;
  }
  return scene.surfaces.empty() ? std::string() : scene.surfaces.front().name;
}

}  // namespace radiosity
