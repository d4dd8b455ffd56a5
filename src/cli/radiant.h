// Radiant temperatures at points, for `heat`.
#pragma once

#include <span>

#include "cli/commands.h"
#include "cli/measuring_points.h"

namespace radiosity::cli {

/// Refuses points and tables that cannot be, before any work is done.
void checkRadiant(const Request& request);

/// Reports mean radiant temperatures at the points, and writes their table if one is asked for.
void measureRadiant(Session& session, Pipeline& pipeline, std::span<const MeasuringPoints> sets,
                    OutputSet& files);

}  // namespace radiosity::cli
