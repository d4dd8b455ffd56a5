#include "scene/image_path.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/lower_case.h"

namespace radiosity {

namespace {

namespace fs = std::filesystem;

/// The file in `folder` called `name`, without regard to case.
std::optional<fs::path> sameNameIn(const fs::path& folder, const std::string& name) {
  std::error_code error;
  const std::string wanted = lowerCase(name);
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(folder.empty() ? "." : folder, error)) {
    if (lowerCase(entry.path().filename().string()) == wanted) {
      found.push_back(folder / entry.path().filename());
    }
  }
  if (found.empty()) return std::nullopt;
  return *std::ranges::min_element(found);
}

std::optional<fs::path> samePathIn(fs::path folder, const fs::path& path) {
  for (const fs::path& step : path) {
    std::error_code error;
    const bool there = step == ".." || fs::exists(folder / step, error);
    const std::optional<fs::path> next = there ? folder / step : sameNameIn(folder, step.string());
    if (!next) return std::nullopt;
    folder = *next;
  }
  return folder;
}

}  // namespace

std::string findImage(const std::string& folder, const std::string& name, FeatureNotes& notes) {
  std::string slashed = name;
  std::replace(slashed.begin(), slashed.end(), '\\', '/');
  const fs::path named = fs::path(folder) / slashed;
  std::error_code error;
  if (fs::exists(named, error)) return named.string();
  if (fs::path(slashed).is_relative()) {
    if (const auto found = samePathIn(folder, slashed)) {
      notes.add("not there, taken from what differs in upper and lower case alone: texture", name);
      return found->string();
    }
  }
  const auto beside = sameNameIn(folder, fs::path(slashed).filename().string());
  if (!beside) return named.string();
  notes.add("not where the file says, taken from beside the scene: texture", name);
  return beside->string();
}

}  // namespace radiosity
