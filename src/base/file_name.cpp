#include "base/file_name.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace radiosity {

std::string lowerExtension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return extension;
}

}  // namespace radiosity
