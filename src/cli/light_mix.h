// Light of single lamps: which there are, and mixtures of it.
#pragma once

#include <optional>
#include <span>

#include "cli/commands.h"
#include "cli/element_use.h"
#include "radiosity/light_basis.h"
#include "radiosity/render.h"

namespace radiosity::cli {

/// InputError where --basis and --mix contradict other options: before the work is done.
void checkMix(const Request& request, const OutputSet& files);

/// Puts the sources of --basis into the pipeline's options, where it is given. InputError where
/// --mix has nothing to mix: before the work is done.
void chooseSources(const Request& request, Pipeline& pipeline);

/// The light of --mix, of what --basis solved or the results file has; none where it is not given.
/// InputError where there is nothing to mix.
std::optional<MixedLight> mixOf(Session& session, Pipeline& pipeline);

/// A mixture as pictures show it: patches, or where `elements` are shown, those of the patches
/// `wanted` (as computeElements()), which are computed anew; by --final-gather light at points.
SurfaceLight mixedSurfaces(Session& session, Pipeline& pipeline, const MixedLight& mix,
                           bool elements, std::span<const std::uint8_t> wanted = {});

}  // namespace radiosity::cli
