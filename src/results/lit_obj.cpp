// Reads Wavefront OBJ with colours after the coordinates of a vertex, as MeshLab, ZBrush and others
// write them: `v x y z r g b`.
#include <fmt/format.h>

#include <map>

#include "base/input_file.h"
#include "base/parse.h"
#include "results/lit_mesh.h"
#include "scene/obj/obj_scan.h"
#include "scene/text.h"

namespace radiosity {

namespace {

class LitObjReader {
 public:
  explicit LitObjReader(LitMesh& mesh) : mesh_(mesh) {}

  void statement(std::size_t line, std::string_view text) {
    line_ = line;
    const std::vector<std::string_view> words = splitWords(text);
    const std::string_view rest = trimmed(text.substr(words[0].size()));
    if (words[0] == "o" || words[0] == "g") {
      object_ = rest;
      surface_ = kNone;
    } else if (words[0] == "usemtl") {
      material_ = rest;
      surface_ = kNone;
    } else if (words[0] == "v") {
      vertex(words);
    } else if (words[0] == "f") {
      face(words);
    }
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", mesh_.file, line_, what));
  }

  void vertex(const std::vector<std::string_view>& words) {
    if (words.size() == 4 || words.size() == 5) {
      fail(
          "a vertex without colour (v x y z r g b), so there is no light to compare; bake the "
          "light into vertex colours and export those; a scene is solved first, and its results "
          "file compared");
    }
    if (words.size() != 7) fail("a vertex with colour has 6 numbers: v x y z r g b");
    std::array<double, 6> numbers{};
    for (std::size_t k = 0; k < 6; ++k) {
      const std::optional<double> number = parseNumber(words[k + 1]);
      if (!number) fail(fmt::format("'{}' is not a finite number; correct it", words[k + 1]));
      numbers[k] = *number;
    }
    mesh_.vertices.emplace_back(numbers[0], numbers[1], numbers[2]);
    colours_.emplace_back(numbers[3], numbers[4], numbers[5]);
  }

  void face(const std::vector<std::string_view>& words) {
    std::vector<Index> corners;
    std::vector<Vec3> colours;
    for (std::size_t k = 1; k < words.size(); ++k) {
      const std::string_view word = words[k].substr(0, words[k].find('/'));
      const std::optional<long long> number = parseInteger(word);
      const auto count = (long long)(mesh_.vertices.size());
      if (!number || *number == 0 || *number > count || *number < -count) {
        fail(fmt::format("corner '{}': there are {} vertices so far; export it again", words[k],
                         count));
      }
      corners.push_back(Index(*number > 0 ? *number - 1 : count + *number));
      colours.push_back(colours_[corners.back()]);
    }
    if (corners.size() < 3) fail("a face has 3 corners or more; export it again");
    if (surface_ == kNone) surface_ = surfaceNow();
    appendLitFace(mesh_, corners, colours, surface_);
  }

  Index surfaceNow() {
    const bool one_name = material_.empty() || material_ == object_;
    const std::string name = one_name ? object_ : object_ + "/" + material_;
    const auto [place, is_new] = surface_of_.try_emplace(name, Index(mesh_.surface_names.size()));
    if (is_new) mesh_.surface_names.push_back(name);
    return place->second;
  }

  LitMesh& mesh_;
  std::vector<Vec3> colours_;
  std::size_t line_ = 0;
  std::string object_ = "unnamed";
  std::string material_;
  Index surface_ = kNone;
  std::map<std::string, Index> surface_of_;  ///< by name
};

}  // namespace

LitMesh readLitObj(const std::string& path) {
  LitMesh mesh;
  mesh.file = path;
  LitObjReader reader(mesh);
  const std::string text = readWholeFile(path);
  forEachStatement(text, [&](std::size_t line, std::string_view statement) {
    reader.statement(line, statement);
  });
  return mesh;
}

}  // namespace radiosity
