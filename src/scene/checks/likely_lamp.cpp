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

/// Whether one of the words is `word`, or more of it.
bool isAbout(std::span<const std::string> words, std::string_view word) {
  return std::ranges::any_of(words, [&](const std::string& w) {
    return isOneOf(w, std::span<const std::string_view>(&word, 1));
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

/// What surfaces together are like, seen with the scene's axis upright.
struct Shape {
  double area = 0;    ///< m^2
  double up = 0;      ///< m^2 that face up
  double down = 0;    ///< m^2 that face down
  double height = 0;  ///< m^3: mean height times area

  Shape& operator+=(const Shape& other) {
    area += other.area;
    up += other.up;
    down += other.down;
    height += other.height;
    return *this;
  }
};

class LampSearch {
 public:
  explicit LampSearch(const Scene& scene);

  /// The surface that matches best, by its material's name, which counts more, or by its own.
  std::string named(std::span<const std::string_view> known) const;
  /// The ceiling that faces down most.
  std::string facingDown() const;

 private:
  int match(const std::string& name, std::span<const std::string_view> known) const;
  template <class Belongs>
  Shape shapeOf(const Belongs& belongs) const;
  bool isHigh(const Shape& shape) const { return shape.height > middle_ * shape.area; }
  bool isCeiling(const Shape& shape) const {
    return shape.down > 0.5 * shape.area && isHigh(shape);
  }
  bool isRoom(const Shape& shape) const;

  const Scene& scene_;
  std::vector<Shape> shapes_;  ///< by surface
  Shape all_;
  double most_up_ = 0;  ///< m^2, of one surface or material
  double middle_ = 0;   ///< half the scene's height
};

LampSearch::LampSearch(const Scene& scene) : scene_(scene), shapes_(scene.surfaces.size()) {
  const auto axis = scene.up == Up::z ? 2 : 1;
  double low = HUGE_VAL;
  double high = -HUGE_VAL;
  for (std::size_t f = 0; f < scene.faceCount(); ++f) {
    const auto face = scene.face(f);
    const Vec3 sum = vectorArea(
        face.size(), [&](std::size_t k) -> const Vec3& { return scene.vertices[face[k]]; });
    for (const Index v : face) {
      low = std::min(low, scene.vertices[v][axis]);
      high = std::max(high, scene.vertices[v][axis]);
    }
    Shape& shape = shapes_[scene.face_surface[f]];
    const double area = glm::length(sum);
    shape.area += area;
    shape.height += area * scene.vertices[face[0]][axis];
    if (sum[axis] > 0.9 * area) shape.up += sum[axis];
    if (-sum[axis] > 0.9 * area) shape.down += -sum[axis];
  }
  middle_ = 0.5 * (low + high);
  std::vector<double> up_of(scene.materials.size(), 0.0);
  for (std::size_t s = 0; s < shapes_.size(); ++s) {
    all_ += shapes_[s];
    up_of[scene.surfaces[s].material] += shapes_[s].up;
    most_up_ = std::max(most_up_, shapes_[s].up);
  }
  for (const double up : up_of) most_up_ = std::max(most_up_, up);
}

template <class Belongs>
Shape LampSearch::shapeOf(const Belongs& belongs) const {
  Shape shape;
  for (std::size_t s = 0; s < shapes_.size(); ++s) {
    if (belongs(scene_.surfaces[s])) shape += shapes_[s];
  }
  return shape;
}

/// Whether a thing called "light" is rather a room's floor, or most of its walls, in a light
/// colour.
bool LampSearch::isRoom(const Shape& shape) const {
  constexpr double kMostOfLamp = 0.4;  // of all area; two of six faces of a cube are a third
  const bool floor = shape.up > 0.5 * shape.area && shape.up >= most_up_ && !isHigh(shape);
  return floor || (shape.area > kMostOfLamp * all_.area && !isCeiling(shape));
}

/// 2: the name has a known word; 1: it has "light" before other words, where it may be a shade
/// ("light wood"); 0: neither.
int LampSearch::match(const std::string& name, std::span<const std::string_view> known) const {
  const std::vector<std::string> words = wordsOf(name);
  if (isShade(scene_, words)) return 0;
  int found = 0;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (!isOneOf(words[k], known)) continue;
    found = std::max(found, words[k] == "light" && k + 1 < words.size() ? 1 : 2);
  }
  return found;
}

std::string LampSearch::named(std::span<const std::string_view> known) const {
  int most = 0;
  std::string name;
  const auto offer = [&](int rank, const std::string& called, const auto& belongs) {
    if (rank <= most) return;
    const bool doubtful = isAbout(wordsOf(called), "light");
    if (doubtful && isRoom(shapeOf(belongs))) return;
    most = rank;
    name = called;
  };
  for (const Surface& surface : scene_.surfaces) {
    const std::string& material = scene_.materials[surface.material].name;
    offer(2 * match(material, known), material,
          [&](const Surface& other) { return other.material == surface.material; });
    offer(2 * match(surface.object, known) - 1, surface.name,
          [&](const Surface& other) { return &other == &surface; });
  }
  return name;
}

/// The surface with most area facing down, if most of its area faces down and it is in the upper
/// half of the scene: the underside of a table is not a ceiling.
std::string LampSearch::facingDown() const {
  std::size_t best = shapes_.size();
  for (std::size_t s = 0; s < shapes_.size(); ++s) {
    if (!isCeiling(shapes_[s])) continue;
    if (best == shapes_.size() || shapes_[s].down > shapes_[best].down) best = s;
  }
  return best < shapes_.size() ? scene_.surfaces[best].name : std::string();
}

}  // namespace

std::string likelyLamp(const Scene& scene) {
  const LampSearch search(scene);
  for (const auto& name :
       {search.named(kLampWords), search.named(kCeilingWords), search.facingDown()}) {
    if (!name.empty()) return name;
  }
  return scene.surfaces.empty() ? std::string() : scene.surfaces.front().name;
}

}  // namespace radiosity
