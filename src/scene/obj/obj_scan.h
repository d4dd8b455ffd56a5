// Reads an OBJ file token by token. Errors that other readers ignore are reported with their line;
// names, lines and cameras are kept.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "radiosity/scene.h"

namespace radiosity {

/// The name of an object or material without one.
inline constexpr std::string_view kUnnamed = "unnamed";

/// Calls visit(line number, text) for every statement of an OBJ or MTL file, comments included.
/// A line that ends in a backslash goes on in the next one; blank lines are left out.
void forEachStatement(std::string_view text,
                      const std::function<void(std::size_t, std::string_view)>& visit);

struct ObjFace {
  std::size_t line;
  Index object;    ///< into ObjScan::objects
  Index material;  ///< into ObjScan::materials, or kNone
};

struct ObjScan {
  std::vector<Vec3> vertices;                  ///< file units, correctly rounded
  std::vector<Vec2> texcoords;                 ///< as written: v grows upwards; NaN: no number
  std::vector<Vec3> colours;                   ///< of vertices, as written; NaN: has none; or empty
  std::vector<ObjFace> faces;                  ///< F, in file order
  std::vector<std::size_t> face_offset = {0};  ///< F + 1, into the two below
  std::vector<Index> corners;                  ///< into vertices
  std::vector<Index> corner_texcoord;          ///< into texcoords, or kNone
  std::vector<std::string> objects;            ///< names, from `o` and `g`
  std::vector<std::string> materials;          ///< names, from `usemtl`
  /// Line and text of every mtllib statement.
  std::vector<std::pair<std::size_t, std::string>> libraries;
  /// (object, material): the object names no material, so the last one applies.
  std::vector<std::pair<Index, Index>> inherited;
  std::vector<Camera> cameras;  ///< file units
  std::vector<Note> notes;
};

/// Errors: InputError "FILE:LINE: what is wrong; cure", also for colours outside 0 to 1. Without
/// `with_colours`, those of vertices are noted and left out.
ObjScan scanObj(const std::string& file, std::string_view text, bool with_colours);

}  // namespace radiosity
