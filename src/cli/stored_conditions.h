// The conditions of heat that a results file keeps.
#pragma once

#include <optional>

#include "cli/commands.h"

namespace radiosity::cli {

/// Those of the heat in the results file, as they were written, and says so; none if it has no
/// heat, or heat whose conditions were not given as text. Errors: as readHeatConditions().
std::optional<HeatConditions> storedConditions(Session& session, const Pipeline& pipeline);

/// Lets the pipeline solve for that heat, or find it in the file. False if there is none.
bool hasHeat(Session& session, Pipeline& pipeline);

/// The same. Errors: InputError with the cure if there is none.
void requireHeat(Session& session, Pipeline& pipeline);

}  // namespace radiosity::cli
