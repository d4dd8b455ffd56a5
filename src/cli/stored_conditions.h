// The conditions of heat that a results file keeps.
#pragma once

#include <optional>

#include "cli/commands.h"

namespace radiosity::cli {

/// Those of the heat in the results file, as they were written, and says so; none if it has no
/// heat, or heat whose conditions were not given as text. Errors: as readHeatConditions().
std::optional<HeatConditions> storedConditions(Session& session, const Pipeline& pipeline);

}  // namespace radiosity::cli
