// One HTML file that shows a lit scene in a browser and computes on: no server, no network. It
// holds patches, form factors, materials and the solution; src/page/README.md has its format.
#pragma once

#include <cstddef>
#include <string>

#include "radiosity/base.h"
#include "radiosity/pipeline.h"
#include "radiosity/scene.h"

namespace [[gnu::visibility("default")]] radiosity {

/// What a page holds at most: form factors are up to 64 MB of codes then, which a browser reads,
/// keeps and solves.
inline constexpr std::size_t kMostPageUnknowns = 8000;
inline constexpr std::size_t kMostPagePatches = 100000;

struct PageOptions {
  std::string title;
  Camera camera;        ///< what the page shows first
  double exposure = 0;  ///< EV, as autoExposure(): radiance B / pi is multiplied by 2^exposure
  double crease = 30;   ///< degrees; smooth shading shares no values across sharper edges
};

/// What form factors lose in 16 bits: logarithms in equal steps.
struct FactorQuantisation {
  double lowest = 0;                  ///< logarithm of the smallest that is kept
  double step = 0;                    ///< code c > 0 stands for exp(lowest + step * c)
  double largest_relative_error = 0;  ///< of one that is kept: exp(step / 2) - 1
  /// The largest sum_j |F_ij as decoded - F_ij| of a row i, those left out among them: by what
  /// share of the largest radiosity an irradiance may be off.
  double largest_row_error = 0;
  /// Pairs with F_ij and F_ji both below 1e-9 / unknowns, which get code 0.
  std::size_t left_out = 0;
};

struct PageReport {
  std::size_t pairs = 0;  ///< form factors kept: one a pair, diagonal included
  FactorQuantisation quantisation;
  std::size_t element_triangles = 0;  ///< of the lit mesh of elements; 0: none
  std::size_t bytes = 0;              ///< of the scene's data, as the browser unpacks it
  std::size_t packed_bytes = 0;       ///< of them in the file: compressed, as text
};

/// False where the program was built without node and npm, which make what a page is filled into.
bool canWritePages();

/// Errors: InputError that starts with `name`, with the numbers and the cure, where a page cannot
/// hold so many unknowns or patches. Form factors are not needed yet.
void requirePageFits(const std::string& name, const PatchMesh& mesh);

/// Writes the page of the pipeline's solution, whole or not at all. `light`: solvedLight() or
/// elementLight(). Errors: of requirePageFits(); InputError where form factors are two estimates a
/// pair, not one (hemicube without symmetrize); RunError where canWritePages() is false and where
/// the file cannot be written; Cancelled.
PageReport writePage(const std::string& path, Pipeline& pipeline, const SurfaceLight& light,
                     const PageOptions& options, Progress& progress);

}  // namespace radiosity
