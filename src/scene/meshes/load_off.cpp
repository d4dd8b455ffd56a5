// Reads OFF, the object file format of Geomview: vertices and faces in text, with numbers of
// vertices from 0 (Phillips, Levy & Munzner, "Geomview Manual", section "OFF Files").
#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "base/input_file.h"
#include "base/parse.h"
#include "scene/grouped_faces.h"
#include "scene/mesh_cursor.h"
#include "scene/readers.h"
#include "scene/text.h"

namespace radiosity {

namespace {

class OffReader {
 public:
  OffReader(const std::string& path, std::string_view content, const SceneOptions& options)
      : cursor_(path, content),
        faces_(path, options),
        stem_(std::filesystem::path(path).stem().string()) {}

  Scene read() {
    nextWords();
    const std::string_view kind = words_.empty() ? std::string_view() : words_[0];
    if (kind != "OFF" && kind != "COFF" && kind != "NOFF" && kind != "CNOFF") {
      cursor_.fail("is no OFF file in text, which begins with OFF, COFF or NOFF; export it again");
    }
    words_.erase(words_.begin());
    if (words_.empty()) nextWords();
    const std::size_t vertices = count(0, "vertices", 6);
    const std::size_t faces = count(1, "faces", 8);
    for (std::size_t v = 0; v < vertices; ++v) vertex();
    for (std::size_t f = 0; f < faces; ++f) face(f);
    faces_.refuseCloud();
    return faces_.finish("export the scene with its faces");
  }

 private:
  /// Reads the words of the next line with words; # comments out the rest of a line.
  void nextWords() {
    do {
      if (cursor_.atEnd()) cursor_.fail("the file ends too early; export it again");
      const std::string_view line = cursor_.nextLine();
      words_ = splitWords(line.substr(0, line.find('#')));
    } while (words_.empty());
  }

  long long integer(std::size_t k, const char* what) const {
    const std::optional<long long> value =
        k < words_.size() ? parseInteger(words_[k]) : std::nullopt;
    if (!value || *value < 0) {
      cursor_.fail(fmt::format("{} `{}` is not a whole number of 0 or more; correct it", what,
                               k < words_.size() ? words_[k] : "(missing)"));
    }
    return *value;
  }

  /// Reads a count. It is refused if the file is too short for items of `least` characters each.
  std::size_t count(std::size_t k, const char* what, std::size_t least) const {
    const auto found = std::size_t(integer(k, what));
    cursor_.require(found, what, NumberType::u8, least / 2);
    return found;
  }

  void vertex() {
    nextWords();
    if (words_.size() < 3) cursor_.fail("a vertex has 3 coordinates; correct the line");
    Vec3 place(0.0);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::optional<double> value = parseNumber(words_[k]);
      if (!value) {
        cursor_.fail(
            fmt::format("coordinate `{}` is not a finite number; write it as 1.5 with a "
                        "decimal point",
                        words_[k]));
      }
      place[int(k)] = *value;
    }
    faces_.addVertex(place);
  }

  /// Reads a face. The colour after the corners is ignored, since it may mean anything.
  void face(std::size_t number) {
    nextWords();
    const auto corners = std::size_t(integer(0, "number of corners"));
    if (corners < 3 || corners >= words_.size()) {
      cursor_.fail("a face has 3 corners or more, each a number; correct or remove it");
    }
    corners_.clear();
    const std::size_t vertices = faces_.scene().vertices.size();
    for (std::size_t k = 1; k <= corners; ++k) {
      const long long vertex = integer(k, "vertex");
      if (std::size_t(vertex) >= vertices) {
        cursor_.fail(fmt::format(
            "vertex {} does not exist, there are {} (from 0); correct the face", vertex, vertices));
      }
      corners_.push_back(Index(vertex));
    }
    faces_.addFace(corners_, stem_, number);
  }

  MeshCursor cursor_;
  GroupedFaces faces_;
  std::string stem_;
  std::vector<std::string_view> words_;  ///< of the present line
  std::vector<Index> corners_;
};

}  // namespace

Scene loadOff(const std::string& path, const SceneOptions& options) {
  return OffReader(path, readWholeFile(path), options).read();
}

}  // namespace radiosity
