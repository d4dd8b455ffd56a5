// Photometric files, their format told by the extension.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/input_file.h"
#include "base/lower_case.h"
#include "scene/lights/photometry/readers.h"

namespace radiosity {

bool isVerticalRange(double first, double last) {
  return (first == 0 || first == 90) && (last == 90 || last == 180) && first < last;
}

double widestStep(std::span<const double> ascending) {
  double widest = 0;
  for (std::size_t k = 1; k < ascending.size(); ++k) {
    widest = std::max(widest, ascending[k] - ascending[k - 1]);
  }
  return widest;
}

Photometry checkedTable(const std::string& file, Photometry table) {
  try {
    table.validate();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}; export it again", file, error.what()));
  }
  return table;
}

Photometry readPhotometry(const std::string& path) {
  requireFile(path);
  const std::string extension = lowerCase(std::filesystem::path(path).extension().string());
  if (extension != ".ies" && extension != ".ldt") {
    throw InputError(fmt::format(
        "{}: is no file of a lamp; give one of IES LM-63 (.ies) or EULUMDAT (.ldt)", path));
  }
  // A degree apart, 0 to 360 and 0 to 180, a table takes half a MiB.
  constexpr std::uintmax_t kMostBytes = std::uintmax_t(64) << 20U;
  std::error_code ignored;
  const std::uintmax_t size = std::filesystem::file_size(path, ignored);
  if (size > kMostBytes) {
    throw InputError(fmt::format("{}: has {} MiB, and files of lamps have at most {}; check it",
                                 path, size >> 20U, kMostBytes >> 20U));
  }
  const std::string content = readWholeFile(path);
  return extension == ".ies" ? readIes(path, content) : readEulumdat(path, content);
}

}  // namespace radiosity
