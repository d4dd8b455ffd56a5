#include "base/file_name.h"

#include <filesystem>

#include "base/lower_case.h"

namespace radiosity {

std::string lowerExtension(const std::string& path) {
  return lowerCase(std::filesystem::path(path).extension().string());
}

}  // namespace radiosity
