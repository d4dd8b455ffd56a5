// Reads View3D's view factors, text and binary (View3D User Manual 3.3, "View Factor Output File").
#include <fmt/format.h>

#include <cstring>

#include "base/finite.h"
#include "base/input_file.h"
#include "base/parse.h"
#include "radiosity/row_matrix.h"
#include "scene/text.h"
#include "tables/matrix_readers.h"

namespace radiosity {

namespace {

/// The bytes of the header line of a binary file, its end included.
constexpr std::size_t kBinaryHeader = 32;

std::vector<double> numbersOfText(const std::string& path, std::string_view text) {
  std::vector<double> numbers;
  std::size_t line_number = 2;
  for (const std::string_view line : splitAt(text, '\n')) {
    for (const std::string_view word : splitWords(line)) {
      const std::optional<double> value = parseNumber(word);
      if (!value) {
        throw InputError(
            fmt::format("{}:{}: `{}` is not a finite number", path, line_number, word));
      }
      numbers.push_back(*value);
    }
    ++line_number;
  }
  return numbers;
}

std::vector<double> numbersOfFloats(std::string_view bytes) {
  std::vector<float> floats(bytes.size() / sizeof(float));
  std::memcpy(floats.data(), bytes.data(), floats.size() * sizeof(float));
  return {floats.begin(), floats.end()};
}

std::vector<double> readNumbers(const std::string& path, const std::string& bytes,
                                const View3dHeader& header) {
  const std::size_t end = header.format == 0 ? bytes.find('\n') : kBinaryHeader - 1;
  const std::string_view rest = std::string_view(bytes).substr(std::min(end + 1, bytes.size()));
  std::vector<double> numbers =
      header.format == 0 ? numbersOfText(path, rest) : numbersOfFloats(rest);
  const std::size_t n = header.rows;
  if (numbers.size() != n * (n + 2)) {
    throw InputError(fmt::format(
        "{}: has {} numbers; areas, factors and emissivities of {} rows are {}; write it again",
        path, numbers.size(), n, n * (n + 2)));
  }
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    if (std::isfinite(numbers[k]) && numbers[k] >= 0) continue;
    throw InputError(
        fmt::format("{}: number {} after the header is {}; areas, factors and "
                    "emissivities are finite and 0 or more",
                    path, k + 1, numbers[k]));
  }
  return numbers;
}

}  // namespace

std::optional<View3dHeader> parseView3dHeader(std::string_view line) {
  const std::vector<std::string_view> words = splitWords(line.substr(0, line.find('\n')));
  // Files of other kinds begin with a letter and numbers.
  constexpr std::size_t kShortestProgram = 3;
  if (words.size() != 6 || words[0].size() < kShortestProgram) return std::nullopt;
  std::array<long long, 4> numbers{};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::optional<long long> value = parseInteger(words[2 + k]);
    const long long most = k == 3 ? 1'000'000 : 1;
    if (!value || *value < 0 || *value > most) return std::nullopt;
    numbers[k] = *value;
  }
  if (numbers[3] == 0) return std::nullopt;
  return View3dHeader{int(numbers[0]), numbers[1] == 1, numbers[2] == 1, std::size_t(numbers[3])};
}

MatrixFile readView3d(const std::string& path, std::span<const double> area) {
  const std::string bytes = readWholeFile(path);
  const std::optional<View3dHeader> header =
      parseView3dHeader(std::string_view(bytes).substr(0, kBinaryHeader + 3));
  if (!header) throw InputError(path + ": the first line is no header of View3D");
  if (header->script) {
    throw InputError(path +
                     ": holds script-F, with emittances in them (emit = 1), which are no form "
                     "factors; let View3D write it with emit = 0");
  }
  const std::vector<double> numbers = readNumbers(path, bytes, *header);
  const std::size_t n = header->rows;
  MatrixFile file;
  const auto at = [&](std::size_t k) { return numbers.begin() + std::ptrdiff_t(k); };
  const auto matrix = std::make_shared<RowMatrix>(chosenAreas(path, area, {at(0), at(n)}),
                                                  Precision::double_precision);
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<Index> columns;
    std::vector<double> values;
    for (Index j = 0; j < n; ++j) {
      const double value = numbers[n + i * n + j];
      if (!(value > 0)) continue;
      columns.push_back(j);
      values.push_back(value);
    }
    matrix->setRow(i, columns, values);
  }
  file.factors.matrix = matrix;
  file.factors.names.resize(n);
  file.emissivity.assign(at(n + n * n), numbers.end());
  file.has_accounts = false;
  return file;
}

}  // namespace radiosity
