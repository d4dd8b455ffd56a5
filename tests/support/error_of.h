// The message of a refusal.
#pragma once

#include <string>

#include "radiosity/base.h"

namespace radiosity::test {

/// The message of the InputError that `action` throws; empty where it throws none.
template <class Action>
std::string errorOf(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace radiosity::test
