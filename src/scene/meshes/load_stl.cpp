// Reads STL (3D Systems, "StereoLithography Interface Specification", 1989): triangles without
// materials, in text with named solids or in binary records of 50 bytes.
#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <glm/geometric.hpp>
#include <optional>
#include <unordered_map>

#include "base/hash.h"
#include "base/input_file.h"
#include "base/lower_case.h"
#include "base/parse.h"
#include "scene/grouped_faces.h"
#include "scene/readers.h"
#include "scene/text.h"

namespace radiosity {

namespace {

static_assert(std::endian::native == std::endian::little, "records are read as they stand");

constexpr std::size_t kStlHeader = 84;  // 80 arbitrary bytes, then the number of triangles
constexpr std::size_t kRecord = 50;     // normal, three corners, two undefined bytes

std::size_t claimedTriangles(std::string_view content) {
  std::uint32_t count = 0;
  std::memcpy(&count, content.data() + 80, sizeof count);
  return count;
}

/// Whether a file is binary: it has exactly the size in its binary header, or it has a zero byte.
/// Exporters begin binary files with "solid", too.
bool isBinary(std::string_view content) {
  if (content.size() >= kStlHeader &&
      content.size() == kStlHeader + kRecord * claimedTriangles(content)) {
    return true;
  }
  return content.find('\0') != std::string_view::npos ||
         lowerCase(trimmed(content.substr(0, 200)).substr(0, 5)) != "solid";
}

/// Adds triangles to a scene; corners at equal places become one vertex.
class StlBuilder {
 public:
  explicit StlBuilder(GroupedFaces& faces) : faces_(faces) {}

  void add(const std::array<Vec3, 3>& corners, const Vec3& normal, const std::string& solid,
           std::size_t element) {
    std::array<Index, 3> face{};
    for (std::size_t k = 0; k < 3; ++k) face[k] = vertexAt(corners[k]);
    faces_.addFace(face, solid, element);
    const Vec3 wound = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    if (glm::dot(wound, normal) < 0) ++against_;
  }

  void noteNormals() {
    if (against_ == 0) return;
    Scene& scene = faces_.scene();
    scene.notes.push_back(
        {Severity::warning,
         fmt::format("{} of {} normals point against the order of the corners; the order counts",
                     against_, scene.faceCount())});
  }

 private:
  struct PlaceHash {
    std::size_t operator()(const Vec3& p) const {
      Hash hash;
      hash.bytes(&p, sizeof p);
      return hash.value();
    }
  };
  Index vertexAt(const Vec3& p) {
    const Vec3 place = p + Vec3(0.0);  // turns -0 into 0
    const auto [found, is_new] = vertex_of_.try_emplace(place, kNone);
    if (is_new) found->second = faces_.addVertex(place);
    return found->second;
  }

  GroupedFaces& faces_;
  std::unordered_map<Vec3, Index, PlaceHash> vertex_of_;
  std::size_t against_ = 0;  ///< normals that disagree with the winding
};

class AsciiReader {
 public:
  AsciiReader(const std::string& file, std::string solid, StlBuilder& builder)
      : file_(file), unnamed_(std::move(solid)), builder_(builder) {}

  void read(std::string_view text) {
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      ++line_;
      statement(trimmed(text.substr(begin, end - begin)));
      begin = end + 1;
    }
    if (in_facet_) fail("the file is cut off within a facet; export it again");
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", file_, line_, what));
  }

  void statement(std::string_view text) {
    const std::vector<std::string_view> words = splitWords(text);
    if (words.empty()) return;
    const std::string keyword = lowerCase(words[0]);
    if (keyword == "solid") {
      outside(words[0]);
      const std::string_view name = trimmed(text.substr(words[0].size()));
      solid_ = name.empty() ? unnamed_ : std::string(name);
    } else if (keyword == "facet") {
      beginFacet(words);
    } else if (keyword == "vertex") {
      vertex(words);
    } else if (keyword == "endfacet") {
      endFacet();
    } else if (keyword == "endsolid") {
      outside(words[0]);
    } else if (keyword != "outer" && keyword != "endloop") {
      fail(
          fmt::format("`{}` is no statement of an STL file; correct it or export again", words[0]));
    }
  }

  void outside(std::string_view word) const {
    if (in_facet_) fail(fmt::format("`{}` within a facet; end it with endfacet", word));
  }

  void beginFacet(const std::vector<std::string_view>& words) {
    outside(words[0]);
    in_facet_ = true;
    facet_line_ = line_;
    count_ = 0;
    normal_ = Vec3(0.0);  // exporters may write "nan" for a facet without area: not used then
    for (std::size_t k = 2; k < 5 && words.size() == 5; ++k) {
      normal_[int(k - 2)] = parseNumber(words[k]).value_or(0.0);
    }
  }

  void vertex(const std::vector<std::string_view>& words) {
    if (!in_facet_) fail("a vertex outside a facet; export the file again");
    if (words.size() != 4) {
      fail(fmt::format("a vertex has 3 coordinates, not {}; correct the line", words.size() - 1));
    }
    if (count_ == 3) fail("a facet of more than 3 vertices; export triangles");
    for (int k = 0; k < 3; ++k) {
      const std::string_view word = words[std::size_t(k) + 1];
      const std::optional<double> number = parseNumber(word);
      if (!number) {
        fail(
            fmt::format("`{}` is not a finite number; write it as 1.5 with a decimal point", word));
      }
      corners_[count_][k] = *number;
    }
    ++count_;
  }

  void endFacet() {
    if (!in_facet_) fail("`endfacet` without a facet; export the file again");
    if (count_ != 3) {
      fail(fmt::format("a facet of {} vertices needs 3; correct or remove it", count_));
    }
    builder_.add(corners_, normal_, solid_, facet_line_);
    in_facet_ = false;
  }

  const std::string& file_;
  std::string unnamed_;
  std::string solid_ = unnamed_;
  StlBuilder& builder_;
  std::size_t line_ = 0;
  std::size_t facet_line_ = 0;
  bool in_facet_ = false;
  std::size_t count_ = 0;  ///< vertices of the facet so far
  std::array<Vec3, 3> corners_{};
  Vec3 normal_{0.0};
};

void readBinary(const std::string& file, std::string_view content, const std::string& solid,
                std::vector<Note>& notes, StlBuilder& builder) {
  const auto fail = [&](const std::string& what) {
    throw InputError(fmt::format("{}: {}; export it again", file, what));
  };
  if (content.size() < kStlHeader)
    fail("is no STL: neither text that begins with solid nor binary");
  const std::size_t count = claimedTriangles(content);
  const std::size_t held = (content.size() - kStlHeader) / kRecord;
  if (count > held) {
    fail(fmt::format("is cut off or no STL: it claims {} triangles and holds {}", count, held));
  }
  bool coloured = false;
  for (std::size_t t = 0; t < count; ++t) {
    std::array<float, 12> numbers{};
    const char* record = content.data() + kStlHeader + kRecord * t;
    std::memcpy(numbers.data(), record, sizeof numbers);
    coloured = coloured || record[48] != 0 || record[49] != 0;
    std::array<Vec3, 4> points{};  // the normal first
    for (std::size_t k = 0; k < 12; ++k) points[k / 3][int(k % 3)] = double(numbers[k]);
    for (std::size_t k = 3; k < 12; ++k) {
      if (!std::isfinite(numbers[k])) {
        fail(fmt::format("triangle {} has a coordinate that is not finite", t));
      }
    }
    builder.add({points[1], points[2], points[3]}, points[0], solid, t);
  }
  const std::size_t rest = content.size() - kStlHeader - kRecord * count;
  if (rest > 0) {
    notes.push_back(
        {Severity::warning, fmt::format("{} bytes after the last triangle are left out", rest)});
  }
  if (coloured) {
    notes.push_back({Severity::info, "colours of triangles (attribute bytes) are not used"});
  }
}

}  // namespace

Scene loadStl(const std::string& path, const SceneOptions& options) {
  const std::string content = readWholeFile(path);
  const std::string stem = std::filesystem::path(path).stem().string();
  GroupedFaces faces(path, options);
  StlBuilder builder(faces);
  if (isBinary(content)) {
    readBinary(path, content, stem, faces.scene().notes, builder);
  } else {
    AsciiReader(path, stem, builder).read(content);
  }
  builder.noteNormals();
  return faces.finish("export the scene with its meshes");
}

}  // namespace radiosity
