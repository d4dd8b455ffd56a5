// Arrays that are used again for other contents.
#pragma once

#include <cstddef>
#include <vector>

namespace radiosity {

/// Makes room for `count` values; earlier ones may be lost. A vector that grows by itself takes up
/// to twice as much.
template <class T>
void makeRoom(std::vector<T>& values, std::size_t count) {
  if (values.size() >= count) return;
  std::vector<T>().swap(values);
  values.resize(count);
}

}  // namespace radiosity
