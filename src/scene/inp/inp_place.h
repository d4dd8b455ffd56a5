// The current place in the input of CalculiX and Abaqus; reads its fields.
#pragma once

#include <string>
#include <string_view>

#include "scene/mesh_cursor.h"

namespace radiosity {

/// A line of a file. All errors are InputErrors "FILE:LINE: what; cure".
struct InpPlace {
  const MeshCursor* cursor = nullptr;
  const std::string* file = nullptr;

  [[noreturn]] void fail(const std::string& what) const { cursor->fail(what); }
  std::string where() const;  ///< "FILE:LINE"

  /// Numbers of a field; `what` names it in the error.
  long long integer(std::string_view word, const char* what) const;
  double coordinate(std::string_view field) const;
};

}  // namespace radiosity
