// JSON read value by value: no tree is built, and what a tree-building library would choke on
// (nesting without end, numbers without bounds) is an error with its place.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace radiosity {

enum class JsonKind { null, boolean, number, text, object, array, end };

/// One value; `object` and `array` stand where it begins, `end` where it ends.
struct JsonValue {
  JsonKind kind = JsonKind::null;
  double number = 0;
  std::string_view text = {};
};

/// Where a value stands in the one around it: the key in an object, or the position in an array.
struct JsonStep {
  std::string key;  ///< empty in an array
  std::size_t index = 0;
};

/// Calls visit(steps from the outermost value, value) for every value of `text`, in order; the path
/// of the outermost is empty. Errors: InputError "FILE: is not JSON, at byte N: ...; cure", among
/// them nesting deeper than 200, and numbers too large for double precision.
void scanJson(const std::string& file, std::string_view text,
              const std::function<void(std::span<const JsonStep>, const JsonValue&)>& visit);

}  // namespace radiosity
