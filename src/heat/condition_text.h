// Conditions as people write them: cells of a table, and "NAME.PROPERTY=VALUE".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radiosity/heat.h"

namespace radiosity {

/// The values that one line gives for the surfaces that it names; missing ones are empty.
struct GivenCondition {
  std::string origin;  ///< "walls.csv:3", "conditions='lamp.power=60'"
  std::string name;
  std::optional<std::vector<Emissivity>> emissivity;
  bool emissivity_of_material = false;  ///< the word `material` in its place
  std::optional<double> temperature;
  std::optional<double> flux;
  std::optional<double> power;
  std::optional<double> convection;
  std::optional<double> ambient;
  std::optional<bool> isothermal;

  bool heated() const { return temperature || flux || power; }
  /// Whether both give the same one of temperature, flux and power.
  bool heatedAs(const GivenCondition& other) const {
    return temperature.has_value() == other.temperature.has_value() &&
           flux.has_value() == other.flux.has_value() &&
           power.has_value() == other.power.has_value();
  }
  bool givesEmissivity() const { return emissivity || emissivity_of_material; }
};

/// The name for every surface; it gives what no other line does.
inline constexpr std::string_view kOthers = "*";

/// Both throw InputError, with the origin, for a text that is not in this form, for a value out of
/// range, and for one that is given twice.
/// `origin`: of the table, for messages.
std::vector<GivenCondition> parseConditionTable(const std::string& origin, std::string_view table);
GivenCondition parseSetting(const std::string& text);

}  // namespace radiosity
