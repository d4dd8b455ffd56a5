// Reads JSON value by value, without a tree. Unbounded nesting and numbers, which a tree-building
// library could not handle, are errors with their place.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace radiosity {

enum class JsonKind { null, boolean, number, text, object, array, end };

/// One value. An object or array is visited as `object` or `array` at its start and as `end` at its
/// end.
struct JsonValue {
  JsonKind kind = JsonKind::null;
  double number = 0;
  std::string_view text = {};
};

/// The place of a value in the one around it: the key in an object, or the position in an array.
struct JsonStep {
  std::string key;  ///< empty in an array
  std::size_t index = 0;
};

/// Calls visit(steps from the outermost value, value) for every value of `text`, in order; the
/// outermost has no steps. Errors: InputError "FILE: is not JSON, at byte N: ...; cure", also for
/// nesting deeper than 200 and for numbers too large for double precision.
void scanJson(const std::string& file, std::string_view text,
              const std::function<void(std::span<const JsonStep>, const JsonValue&)>& visit);

}  // namespace radiosity
