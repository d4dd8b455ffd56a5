// Light of single lamps, and mixtures of it.
#pragma once

#include <optional>
#include <span>

#include "cli/commands.h"
#include "cli/element_use.h"
#include "radiosity/light_basis.h"
#include "radiosity/render.h"

namespace radiosity::cli {

/// --basis: a source for each surface that emits. Other values name a table.
inline constexpr const char* kBasisOfSurfaces = "surfaces";

/// Throws InputError if --basis and --mix contradict other options, before any work is done.
void checkMix(const Request& request, const OutputSet& files);

/// Puts the sources of --basis, if given, into the pipeline's options. Throws InputError if --mix
/// has nothing to mix, before any work is done.
void chooseSources(const Request& request, Pipeline& pipeline);

/// The light of --mix, from the sets that --basis solved or the results file has; empty without
/// --mix. Errors: InputError if there is nothing to mix.
std::optional<MixedLight> mixOf(Session& session, Pipeline& pipeline);

/// A mixture for pictures: patches or, if `elements` are shown, elements of the patches `wanted`
/// (see computeElements()), which are computed anew; with --final-gather, light at points.
SurfaceLight mixedSurfaces(Session& session, Pipeline& pipeline, const MixedLight& mix,
                           bool elements, std::span<const std::uint8_t> wanted = {});

}  // namespace radiosity::cli
