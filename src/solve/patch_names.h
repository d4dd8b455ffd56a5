// Names of patches in messages.
#pragma once

#include <span>
#include <string>

#include "radiosity/base.h"

namespace radiosity {

/// Their surfaces, where these are known.
struct PatchNames {
  std::span<const Index> group;
  std::span<const std::string> names;

  std::string of(std::size_t i) const;
  /// A list of the surfaces of some patches, or of the patches if surfaces are not known: each
  /// once, at most twenty.
  std::string list(std::span<const std::size_t> patches) const;
};

}  // namespace radiosity
