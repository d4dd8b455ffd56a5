// Tables of lamps as texts, so that a light needs its file once.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "base/base64.h"
#include "base/parse.h"
#include "base/printable.h"
#include "radiosity/photometry.h"
#include "scene/lights/light_text.h"

namespace radiosity {

namespace {

constexpr char kBetween = '|';
constexpr char kBetweenNumbers = '/';

/// As they stand in texts.
constexpr std::string_view kTypeWords[] = {"c", "b", "a"};

constexpr const char* kDamaged = "its table is damaged";

std::vector<double> numbersIn(std::string_view text) {
  std::vector<double> numbers;
  for (const std::string_view word : splitAt(text, kBetweenNumbers)) {
    const std::optional<double> number = parseNumber(word);
    if (!number) throw InputError(kDamaged);
    numbers.push_back(*number);
  }
  return numbers;
}

}  // namespace

std::string Photometry::text() const {
  const std::string_view bytes(reinterpret_cast<const char*>(candela.data()),
                               candela.size() * sizeof(float));
  std::string packed = base64(bytes);
  packed.resize(packed.find_last_not_of('=') + 1);
  return fmt::format("{}|{}{}/{}/{}|{}/{}|{}|{}|{}", kTypeWords[std::size_t(type)],
                     round ? "o" : "", opening.x, opening.y, opening.z, lamps, stated,
                     fmt::join(vertical, "/"), fmt::join(horizontal, "/"), packed);
}

Photometry Photometry::ofText(std::string_view text) {
  const std::vector<std::string_view> parts = splitAt(text, kBetween);
  Photometry table;
  const auto* const word = std::ranges::find(kTypeWords, parts[0]);
  if (parts.size() != 6 || word == std::end(kTypeWords)) throw InputError(kDamaged);
  table.type = PhotometryType(word - kTypeWords);
  table.round = parts[1].starts_with('o');
  const std::vector<double> sizes = numbersIn(parts[1].substr(table.round ? 1 : 0));
  const std::vector<double> lumens = numbersIn(parts[2]);
  const std::optional<std::string> bytes = ofBase64(parts[5]);
  if (sizes.size() != 3 || lumens.size() != 2 || !bytes || bytes->size() % sizeof(float) != 0) {
    throw InputError(kDamaged);
  }
  table.opening = {sizes[0], sizes[1], sizes[2]};
  table.lamps = lumens[0];
  table.stated = lumens[1];
  table.vertical = numbersIn(parts[3]);
  table.horizontal = numbersIn(parts[4]);
  table.candela.resize(bytes->size() / sizeof(float));
  std::memcpy(table.candela.data(), bytes->data(), bytes->size());
  table.validate();
  return table;
}

LampFile::LampFile(std::string name, Photometry table)
    : name_(std::move(name)), flux_(table.flux()) {
  table_ = std::make_shared<const Photometry>(std::move(table));
}

std::string LampFile::optionText() const {
  return empty() ? "" : encodedText(name_) + kBetween + table_->text();
}

namespace {

Photometry tableOf(const std::string& name, std::string_view text) {
  try {
    return Photometry::ofText(text);
  } catch (const InputError& error) {
    throw InputError(
        fmt::format("{}: {}; give the lamp's file again, and write %7c for a | in its name",
                    printable(name), error.what()));
  }
}

}  // namespace

bool LampFile::readOption(std::string_view text) {
  const std::size_t bar = text.find(kBetween);
  const std::string name = decodedText(text.substr(0, bar));
  if (name.empty()) return false;
  if (bar != text.npos) {
    *this = LampFile(name, tableOf(name, text.substr(bar + 1)));
  } else {
    *this = LampFile(std::filesystem::path(name).filename().string(), readPhotometry(name));
  }
  return true;
}

bool LampFile::operator==(const LampFile& other) const {
  if (name_ != other.name_ || empty() != other.empty()) return false;
  return table_ == other.table_ || table() == other.table();
}

}  // namespace radiosity
