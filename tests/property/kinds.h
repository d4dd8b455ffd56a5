// The kinds of random scenes.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "model.h"

namespace radiosity::property {

struct Kind {
  const char* name;
  void (*fill)(Model& model, class Draw& draw);
};

std::span<const Kind> kinds();

/// The scene of a kind and a seed: always the same. It is turned, scaled (1e-6 to 1e6) and moved
/// away (up to 1e6 times its size) at random.
Model makeModel(const Kind& kind, std::uint64_t seed);

}  // namespace radiosity::property
