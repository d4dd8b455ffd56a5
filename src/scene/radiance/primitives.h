// Reads the primitives of a Radiance scene file: G. Ward, "The RADIANCE Synthetic Imaging System",
// section 1 (Scene Description).
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scene/mesh_cursor.h"

namespace radiosity {

enum class RadianceKind { surface, material, pattern, bump, mixture, alias };

/// A type of primitive.
struct RadianceType {
  static constexpr std::size_t kAny = std::size_t(-1);

  const char* word;
  RadianceKind kind;
  const char* numbers = "";  ///< what its numbers are; empty: they are not read
  std::size_t count = kAny;  ///< of its numbers
  std::size_t most = 0;      ///< the same, at most, if there may be more
  std::size_t most_strings = kAny;
};

struct RadiancePrimitive {
  const RadianceType* type = nullptr;
  Index modifier = kNone;  ///< into the modifiers that were read before; kNone: void
  std::string name;
  std::vector<std::string> strings;
  std::vector<double> numbers;
  std::size_t line = 0;

  bool is(std::string_view word) const { return type->word == word; }
  /// Three of the numbers: a place, a direction or a colour.
  Vec3 three(std::size_t first) const {
    return {numbers[first], numbers[first + 1], numbers[first + 2]};
  }
  std::string text() const { return std::string(type->word) + " " + name; }
};

/// Reads a file from beginning to end.
class RadianceReader {
 public:
  /// `content` must outlive it.
  RadianceReader(const std::string& path, std::string_view content)
      : path_(path), cursor_(path, content) {}

  /// Reads up to the next surface; primitives before it are added to modifiers(). False at the end.
  /// Errors: InputError "FILE:LINE: PRIMITIVE: what; cure", for commands, too.
  bool nextSurface(RadiancePrimitive& found);

  /// All that were read so far, aliases as what they stand for; they stay in their places.
  const std::deque<RadiancePrimitive>& modifiers() const { return modifiers_; }

  [[noreturn]] void fail(const RadiancePrimitive& primitive, const std::string& what) const;

 private:
  bool findPrimitive();
  RadiancePrimitive primitive();
  std::string word();
  Index modifierCalled(std::string_view name) const;
  void readAlias(RadiancePrimitive& alias, bool inherits);
  void readArguments(RadiancePrimitive& primitive);
  void checkArguments(const RadiancePrimitive& primitive) const;

  std::string path_;
  MeshCursor cursor_;
  std::deque<RadiancePrimitive> modifiers_;
  std::map<std::string, Index, std::less<>> modifier_of_;  ///< the last of a name
};

}  // namespace radiosity
