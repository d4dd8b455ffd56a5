// Conditions as people write them: cells of a table, and "NAME.PROPERTY=VALUE".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radiosity/heat.h"

namespace radiosity {

/// What one line says of the surfaces it names; what it leaves out is empty.
struct GivenCondition {
  std::string origin;  ///< "walls.csv:3", "--condition lamp.power=60"
  std::string name;
  std::optional<std::vector<Emissivity>> emissivity;
  std::optional<double> temperature;
  std::optional<double> flux;
  std::optional<double> power;
  std::optional<double> convection;
  std::optional<double> ambient;
  std::optional<bool> isothermal;

  bool heated() const { return temperature || flux || power; }
};

/// The name for all surfaces that no other one names.
inline constexpr std::string_view kOthers = "*";

/// Errors of both: InputError, with the origin: for what is not written like this, not within its
/// range or said twice.
/// `origin`: of the table, for messages.
std::vector<GivenCondition> parseConditionTable(const std::string& origin, std::string_view table);
GivenCondition parseSetting(const std::string& text);

}  // namespace radiosity
