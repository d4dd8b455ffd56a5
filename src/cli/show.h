// Pictures in false colours: the quantities of --show.
#pragma once

#include <optional>
#include <string>

#include "cli/commands.h"
#include "cli/picture.h"
#include "radiosity/pipeline.h"

namespace radiosity::cli {

/// The quantity of --show; neither: the lit scene itself.
struct Show {
  std::optional<Quantity> quantity;  ///< of patches
  std::size_t patch = 0;
  std::optional<ShownLight> light;  ///< of the picture's light

  bool needsLight() const {
    return !quantity || *quantity == Quantity::radiosity || *quantity == Quantity::irradiance;
  }
  bool needsHeat() const {
    return quantity == Quantity::temperature || quantity == Quantity::net_flux ||
           quantity == Quantity::heat_irradiance;
  }
};

/// Errors: InputError for a word that is none, with the nearest.
Show parseShow(const std::string& text);

/// The ends of --range; empty: automatic. Errors: InputError.
struct ShownRange {
  double low = 0;
  double high = 0;
};
ShownRange parseRange(const std::string& text);

/// Throws InputError unless the mesh has the patch of a form factor.
void requirePatch(const Show& show, const PatchMesh& mesh);

/// Writes a quantity of patches, or of one, to the .png and .exr among `files`.
void drawQuantity(Session& session, Pipeline& pipeline, const Picture& picture, Quantity quantity,
                  std::size_t patch, OutputSet& files);

/// Writes the light of a picture, as its radiance, likewise.
void drawLight(Session& session, const PatchMesh& mesh, const Image& radiance, int bands,
               const Picture& picture, const ShownLight& unit, OutputSet& files);

}  // namespace radiosity::cli
