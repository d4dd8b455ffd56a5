#include "scene/radiance/primitives.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/printable.h"

namespace radiosity {

namespace {

using enum RadianceKind;

/// All types of Radiance 6.
constexpr std::array kTypes = {
    RadianceType{"source", surface, "direction and angle", 4, 0, 0},
    RadianceType{"sphere", surface, "centre and radius", 4, 0, 0},
    RadianceType{"bubble", surface, "centre and radius", 4, 0, 0},
    RadianceType{"polygon", surface, "three a corner", 9, RadianceType::kAny, 0},
    RadianceType{"cone", surface, "both ends and their radii", 8, 0, 0},
    RadianceType{"cup", surface, "both ends and their radii", 8, 0, 0},
    RadianceType{"cylinder", surface, "both ends and the radius", 7, 0, 0},
    RadianceType{"tube", surface, "both ends and the radius", 7, 0, 0},
    RadianceType{"ring", surface, "centre, direction and both radii", 8, 0, 0},
    RadianceType{"mesh", surface},
    RadianceType{"instance", surface},
    RadianceType{"light", material, "red, green and blue radiance", 3, 0, 0},
    RadianceType{"illum", material, "red, green and blue radiance", 3, 0, 1},
    RadianceType{"glow", material, "red, green and blue radiance, and the radius", 4, 0, 0},
    RadianceType{"spotlight", material},
    RadianceType{"plastic", material, "red, green, blue, specularity and roughness", 5, 0, 0},
    RadianceType{"metal", material, "red, green, blue, specularity and roughness", 5, 0, 0},
    RadianceType{"trans", material,
                 "red, green, blue, specularity, roughness, transmissivity and its specular share",
                 7, 0, 0},
    RadianceType{"plastic2", material, "red, green, blue, specularity and two of roughness", 6},
    RadianceType{"metal2", material, "red, green, blue, specularity and two of roughness", 6},
    RadianceType{"trans2", material,
                 "red, green, blue, specularity, two of roughness, transmissivity and its specular "
                 "share",
                 8},
    RadianceType{"mirror", material, "red, green and blue", 3, 0, 1},
    RadianceType{"glass", material, "red, green and blue transmissivity", 3, 4, 0},
    RadianceType{"dielectric", material, "three of transmission, two of refraction", 5, 0, 0},
    RadianceType{"interface", material, "four a side", 8, 0, 0},
    RadianceType{"antimatter", material},
    RadianceType{"mist", material},
    RadianceType{"prism1", material},
    RadianceType{"prism2", material},
    RadianceType{"ashik2", material},
    RadianceType{"plasfunc", material},
    RadianceType{"metfunc", material},
    RadianceType{"transfunc", material},
    RadianceType{"BRTDfunc", material},
    RadianceType{"plasdata", material},
    RadianceType{"metdata", material},
    RadianceType{"transdata", material},
    RadianceType{"BSDF", material},
    RadianceType{"aBSDF", material},
    RadianceType{"sBSDF", material},
    RadianceType{"WGMDfunc", material},
    RadianceType{"texfunc", bump},
    RadianceType{"texdata", bump},
    RadianceType{"colorfunc", pattern},
    RadianceType{"brightfunc", pattern},
    RadianceType{"colordata", pattern},
    RadianceType{"brightdata", pattern},
    RadianceType{"colorpict", pattern},
    RadianceType{"colortext", pattern},
    RadianceType{"brighttext", pattern},
    RadianceType{"spectrum", pattern},
    RadianceType{"specfile", pattern},
    RadianceType{"specfunc", pattern},
    RadianceType{"specdata", pattern},
    RadianceType{"specpict", pattern},
    RadianceType{"mixfunc", mixture},
    RadianceType{"mixdata", mixture},
    RadianceType{"mixpict", mixture},
    RadianceType{"mixtext", mixture},
    RadianceType{"alias", alias},
};

const RadianceType* typeCalled(std::string_view word) {
  const auto* found = std::ranges::find(
      kTypes, word, [](const RadianceType& type) { return std::string_view(type.word); });
  return found == kTypes.end() ? nullptr : found;
}

constexpr std::string_view kVoid = "void";
constexpr std::string_view kInherit = "inherit";

}  // namespace

void RadianceReader::fail(const RadiancePrimitive& primitive, const std::string& what) const {
  throw InputError(
      fmt::format("{}:{}: {}: {}", path_, primitive.line, printable(primitive.text()), what));
}

/// Passes comments. False at the end of the file.
bool RadianceReader::findPrimitive() {
  while (!cursor_.atEnd()) {
    if (cursor_.startsWith("!")) {
      cursor_.fail(fmt::format(
          "`{}` is a command, and commands are not run; expand the scene first, by Radiance: xform "
          "{} > expanded.rad",
          printable(cursor_.nextLine().substr(0, 60)), path_));
    }
    if (!cursor_.startsWith("#")) return true;
    cursor_.nextLine();
  }
  return false;
}

/// The next word, or several in quotes.
std::string RadianceReader::word() {
  std::string found(cursor_.word());
  const char quote = found.front();
  if (quote != '"' && quote != '\'') return found;
  while (found.size() < 2 || found.back() != quote) found.append(" ").append(cursor_.word());
  return found.substr(1, found.size() - 2);
}

Index RadianceReader::modifierCalled(std::string_view name) const {
  const auto found = modifier_of_.find(name);
  return found == modifier_of_.end() ? kNone : found->second;
}

bool RadianceReader::nextSurface(RadiancePrimitive& found) {
  while (findPrimitive()) {
    RadiancePrimitive next = primitive();
    if (next.type->kind == surface) {
      found = std::move(next);
      return true;
    }
    modifier_of_.insert_or_assign(next.name, Index(modifiers_.size()));
    modifiers_.push_back(std::move(next));
  }
  return false;
}

RadiancePrimitive RadianceReader::primitive() {
  const std::string modifier = word();
  RadiancePrimitive next;
  next.line = cursor_.line();
  next.modifier = modifierCalled(modifier);
  const std::string type = word();
  next.type = typeCalled(type);
  if (next.type == nullptr) {
    cursor_.fail(
        fmt::format("`{}` is no type of primitive; a primitive is MODIFIER TYPE NAME, then "
                    "three counts, each with its arguments",
                    printable(type)));
  }
  next.name = word();
  const bool inherits = modifier == kInherit && next.type->kind == alias;
  if (next.modifier == kNone && modifier != kVoid && !inherits) {
    fail(next,
         fmt::format("its modifier `{}` is not defined before; define it, or correct the name",
                     printable(modifier)));
  }
  if (next.type->kind == alias) {
    readAlias(next, inherits);
  } else {
    readArguments(next);
    checkArguments(next);
  }
  return next;
}

void RadianceReader::readAlias(RadiancePrimitive& alias, bool inherits) {
  const std::string name = word();
  const Index meant = modifierCalled(name);
  if (meant == kNone) {
    fail(alias, fmt::format("`{}` is not defined before; define it, or correct the name",
                            printable(name)));
  }
  const RadiancePrimitive& of = modifiers_[meant];
  alias.type = of.type;
  alias.strings = of.strings;
  alias.numbers = of.numbers;
  if (inherits) alias.modifier = of.modifier;
}

void RadianceReader::readArguments(RadiancePrimitive& primitive) {
  const auto count = [&](const char* what) {
    const std::string named = fmt::format("{}: number of {}", printable(primitive.text()), what);
    return cursor_.count(NumberType::u64, named.c_str(), NumberType::u8);
  };
  const std::size_t strings = count("strings");
  for (std::size_t k = 0; k < strings; ++k) primitive.strings.push_back(word());
  if (count("integers") != 0) fail(primitive, "no primitive has integers; their number is 0");
  const std::size_t numbers = count("numbers");
  const std::string argument = printable(primitive.text()) + ": argument";
  for (std::size_t k = 0; k < numbers; ++k) {
    primitive.numbers.push_back(cursor_.number(NumberType::f64, argument.c_str()));
  }
}

void RadianceReader::checkArguments(const RadiancePrimitive& primitive) const {
  const RadianceType& type = *primitive.type;
  if (primitive.strings.size() > type.most_strings) {
    fail(primitive, fmt::format("has {} strings, it takes {}{}; correct it",
                                primitive.strings.size(), type.most_strings == 0 ? "" : "at most ",
                                type.most_strings == 0 ? "none" : "1"));
  }
  if (type.count == RadianceType::kAny) return;
  const std::size_t most = std::max(type.count, type.most);
  const std::size_t numbers = primitive.numbers.size();
  const bool by_threes = type.most != RadianceType::kAny || numbers % 3 == 0;
  if (numbers >= type.count && numbers <= most && by_threes) return;
  std::string taken = std::to_string(type.count);
  if (most == RadianceType::kAny) taken += " or more";
  if (most > type.count && most != RadianceType::kAny) taken += fmt::format(" or {}", most);
  fail(primitive,
       fmt::format("has {} numbers, it takes {} ({}); correct it", numbers, taken, type.numbers));
}

}  // namespace radiosity
