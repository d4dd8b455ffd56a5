// Access to values that must have been made already.
#pragma once

#include <stdexcept>

namespace radiosity {

/// The value of an optional that must be set by now. Throws logic_error if it is not.
template <class Optional>
auto& made(Optional& value) {
  if (!value) throw std::logic_error("a stage was used before it was made");
  return *value;
}

}  // namespace radiosity
