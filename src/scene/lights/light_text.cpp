// Lights from their texts, and back.
#include "scene/lights/light_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <ranges>

#include "base/option_list.h"
#include "base/printable.h"
#include "radiosity/spelling.h"

namespace radiosity {

namespace {

constexpr std::string_view kName = "name";
/// They end a value, a light in the key of a stage, or the name of a file before its table.
constexpr std::string_view kReserved = "%,;=| \n\t";

bool isSky(const Light& light) { return std::holds_alternative<UniformSky>(light.kind); }

/// A parameter with its values, without a name where they stand first.
struct Given {
  std::string name;
  std::vector<std::string_view> values;

  std::string text() const { return fmt::format("{}", fmt::join(values, ",")); }
};

/// What stands between commas belongs to the NAME= before it.
std::vector<Given> givenIn(std::string_view text) {
  std::vector<Given> all;
  if (text.empty()) return all;
  for (const std::string_view part : splitAt(text, ',')) {
    const std::size_t equals = part.find('=');
    if (equals != part.npos) {
      all.push_back({std::string(part.substr(0, equals)), {part.substr(equals + 1)}});
    } else {
      if (all.empty()) all.emplace_back();
      all.back().values.push_back(part);
    }
  }
  return all;
}

/// Calls visit(line, field) for each parameter of a light.
template <class Kind, class Visit>
void forParameters(Kind& kind, const Visit& visit) {
  const auto list = [&](const OptionLine& line, auto& field, const OptionRange& = {}) {
    visit(line, field);
  };
  std::visit([&](auto& of) { of.describe(list, of); }, kind);
}

std::span<const char* const> unnamedOf(const Light& light) {
  return std::visit(
      [](const auto& of) -> std::span<const char* const> {
        if constexpr (requires { of.kUnnamed; }) return of.kUnnamed;
        return {};
      },
      light.kind);
}

/// A light while its text is read.
class Reading {
 public:
  Reading(const std::string& word, const std::string& text, int bands)
      : light_(ofKind(word)), text_(text), bands_(std::size_t(bands)) {}

  Light light() {
    for (const Given& given : givenIn(text_)) take(given);
    if (light_.strength.empty()) takeUsual();
    if (light_.strength.size() == 1) light_.strength.resize(bands_, light_.strength[0]);
    if (light_.strength.size() != bands_) failAtStrength();
    settleUnit();
    return std::move(light_);
  }

 private:
  static Light ofKind(const std::string& word) {
    std::vector<Light> kinds = lightKinds();
    const auto kind = std::ranges::find(kinds, word, &Light::name);
    if (kind != kinds.end()) return std::move(*kind);
    throw InputError(fmt::format("{}: no light is called '{}'; there are {}", spelled("light"),
                                 word,
                                 fmt::join(kinds | std::views::transform(&Light::name), ", ")));
  }

  void take(const Given& given) {
    if (given.name == kName) {
      light_.name = decodedText(given.text());
      if (light_.name.empty()) fail("has an empty name");
      const auto isKind = [&](const Light& kind) {
        return kind.traits().single && kind.name == light_.name &&
               kind.kind.index() != light_.kind.index();
      };
      if (std::ranges::any_of(lightKinds(), isKind)) {
        fail(fmt::format("'{}' is the name of another light; give it one of its own", light_.name));
      }
    } else if (const std::size_t count = unnamedIn(given); count > 0) {
      for (std::size_t k = 0; k < count; ++k) {
        set(unnamedOf(light_)[k], std::string(given.values[k]));
      }
      if (count == given.values.size()) return;
      takeStrength({"", {given.values.begin() + std::ptrdiff_t(count), given.values.end()}});
    } else if (given.name.empty() || given.name == light_.traits().strength) {
      takeStrength(given);
    } else {
      set(given.name, given.text());
    }
  }

  /// How many of the values that have no name are parameters: one that is no strength may come
  /// before that; several stand for it.
  std::size_t unnamedIn(const Given& given) const {
    const std::size_t count = unnamedOf(light_).size();
    if (!given.name.empty() || count == 0 || given.values.size() < count) return 0;
    if (count == 1) return strengthIn(given.values[0]) ? 0 : 1;
    const auto isNoNumber = [](std::string_view value) { return !parseNumber(value); };
    const bool fits = given.values.size() == count && isNoNumber(given.values.back()) &&
                      !std::ranges::all_of(given.values, isNoNumber);
    return fits ? count : 0;
  }

  void takeUsual() {
    const double usual = std::visit(
        [](const auto& of) {
          if constexpr (!requires { of.usual(); })
            return of.kTraits.usual;
          else {
            of.validate();
            return of.usual();
          }
        },
        light_.kind);
    if (usual > 0) light_.strength = {usual};
    light_.photometric = !light_.fileName().empty();
  }

  struct Strength {
    double number;
    std::string_view unit;
  };
  std::optional<Strength> strengthIn(std::string_view value) const {
    double number = 0;
    const char* end = value.data() + value.size();
    const auto [rest, error] = std::from_chars(value.data(), end, number);
    const std::string_view unit(rest, std::size_t(end - rest));
    if (error != std::errc() || !std::isfinite(number) || !isUnit(unit)) return std::nullopt;
    return Strength{number, unit};
  }

  void takeStrength(const Given& given) {
    light_.strength.clear();
    for (const std::string_view value : given.values) {
      const std::optional<Strength> strength = strengthIn(value);
      if (!strength) failAtStrength();
      if (!strength->unit.empty()) unit_ = strength->unit;
      light_.strength.push_back(strength->number);
    }
  }

  bool isUnit(std::string_view unit) const {
    const LightTraits& traits = light_.traits();
    const bool of_power = unit == "W" || unit == "lm";
    const Light one{light_.name, light_.kind, {1.0}};
    return unit.empty() || unit == traits.unit || unit == traits.photometric ||
           (of_power && one.power(0));
  }

  /// The cone that a power spreads over may be given after it.
  void settleUnit() {
    double each = 1;
    if (unit_ == light_.traits().photometric || unit_ == "lm") {
      each = 1 / kLumensPerWatt;
      light_.photometric = true;
    }
    if (unit_ == "W" || unit_ == "lm") {
      light_.validate();
      each /= Light{light_.name, light_.kind, {1.0}}.power(0).value_or(1);  // isUnit(): it has one
    }
    for (double& strength : light_.strength) strength *= each;
  }

  void set(const std::string& name, const std::string& value) {
    bool known = false;
    bool read = false;
    forParameters(light_.kind, [&](const OptionLine& line, auto& field) {
      if (line.optionName() != name) return;
      known = true;
      read = readOption(line, value, field);
      if (!read) fail(fmt::format("{} '{}' is not {}", name, value, line.value));
    });
    if (known) return;
    std::vector<std::string> names = light_.parameterNames();
    names.insert(names.begin(), {light_.traits().strength, std::string(kName)});
    fail(fmt::format("'{}' is no parameter of it; there are {}", name, fmt::join(names, ", ")));
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", light_.option(), what));
  }

  [[noreturn]] void failAtStrength() const {
    const LightTraits& traits = light_.traits();
    fail(fmt::format("'{}' is not one finite number or {} with commas, {}{}", text_,
                     bands_ == 3 ? "three" : std::to_string(bands_), traits.unit,
                     traits.single ? "" : fmt::format(" (or {})", traits.photometric)));
  }

  Light light_;
  const std::string& text_;
  std::size_t bands_;
  std::string unit_;
};

}  // namespace

std::string encodedText(std::string_view name) {
  std::string text;
  for (const char c : name) {
    text += kReserved.find(c) == kReserved.npos ? std::string(1, c)
                                                : fmt::format("%{:02x}", std::uint8_t(c));
  }
  return text;
}

std::string decodedText(std::string_view text) {
  std::string name;
  for (std::size_t k = 0; k < text.size(); ++k) {
    unsigned code = 0;
    const char* digits = text.data() + k + 1;
    const bool whole = text[k] == '%' && k + 2 < text.size() &&
                       std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2;
    name += whole ? char(code) : text[k];
    if (whole) k += 2;
  }
  return name;
}

std::vector<std::string> Light::parameterNames() const {
  std::vector<std::string> names;
  forParameters(kind, [&](const OptionLine& line, const auto& /*field*/) {
    if (*line.help != '\0') names.push_back(line.optionName());
  });
  return names;
}

namespace {

std::string parametersOf(const Light& light, bool brief) {
  std::vector<Light> kinds = lightKinds();
  std::vector<std::string> usual;
  forParameters(kinds[light.kind.index()].kind, [&](const OptionLine& line, const auto& value) {
    usual.push_back(optionText(line, value));
  });
  std::string text;
  std::size_t k = 0;
  forParameters(light.kind, [&](const OptionLine& line, const auto& value) {
    std::string now = optionText(line, value);
    const bool is_usual = now == usual[k++];
    if constexpr (kHasText<std::remove_cvref_t<decltype(value)>>) {
      if (brief) now = encodedText(value.name());
    }
    if (!is_usual && !(brief && *line.help == '\0')) text += "," + line.optionName() + "=" + now;
  });
  if (light.name != light.traits().word)
    text += fmt::format(",{}={}", kName, encodedText(light.name));
  return text;
}

}  // namespace

std::string Light::parametersText() const { return parametersOf(*this, false); }

std::string Light::briefText() const { return parametersOf(*this, true); }

Light lightOf(const std::string& word, const std::string& text, int bands) {
  return Reading(word, text, bands).light();
}

Light lightOf(const std::string& text) {
  const std::size_t comma = text.find(',');
  return lightOf(text.substr(0, comma), comma == text.npos ? "" : text.substr(comma + 1));
}

std::vector<double> skyRadiance(std::span<const Light> lights) {
  const auto sky = std::ranges::find_if(lights, isSky);
  return sky == lights.end() ? std::vector<double>() : sky->strength;
}

std::vector<std::string> otherLights(std::span<const Light> lights) {
  std::vector<std::string> texts;
  for (const Light& light : lights) {
    if (isSky(light)) continue;
    texts.push_back(fmt::format("{}={}{}", light.traits().word, strengthText(light.strength),
                                light.parametersText()));
  }
  return texts;
}

std::vector<Light> lightsOf(const std::vector<double>& sky, std::span<const std::string> others,
                            int bands) {
  std::vector<Light> lights;
  if (!sky.empty()) lights.push_back(uniformSky(sky));
  for (const std::string& text : others) {
    const std::size_t equals = text.find('=');
    const bool whole = equals != std::string::npos;
    lights.push_back(lightOf(text.substr(0, equals), whole ? text.substr(equals + 1) : "", bands));
  }
  return lights;
}

std::string standText(const Light& light, Up up) {
  if (const auto* sun = std::get_if<Sun>(&light.kind)) {
    const SolarPosition stands = standingOf(sun->toward, up);
    return fmt::format("{:.4g} degrees above the horizon, azimuth {:.4g}", stands.elevation,
                       stands.azimuth);
  }
  const std::optional<Vec3> at = light.place();
  if (!at) return "";
  const std::string file = light.fileName();
  return fmt::format("at {:.6g},{:.6g},{:.6g}{}", at->x, at->y, at->z,
                     file.empty() ? "" : ", " + printable(file));
}

std::string strengthText(std::span<const double> strength) {
  if (strength.empty()) return "0";
  const bool grey = std::ranges::all_of(strength, [&](double s) { return s == strength[0]; });
  return grey ? fmt::format("{}", strength[0]) : fmt::format("{}", fmt::join(strength, ","));
}

}  // namespace radiosity
