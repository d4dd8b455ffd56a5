// Conditions of heat by name.
#pragma once

#include <string>

#include "radiosity/heat.h"

namespace radiosity::test {

inline HeatCondition condition(const std::string& name, double emissivity) {
  HeatCondition c;
  c.name = name;
  c.emissivity = {{{}, {emissivity}}};
  return c;
}

inline HeatCondition at(const std::string& name, double emissivity, double temperature) {
  HeatCondition c = condition(name, emissivity);
  c.temperature = temperature;
  return c;
}

}  // namespace radiosity::test
