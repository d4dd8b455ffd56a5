// One HTML file that shows a lit scene and computes in a browser: no server, no network. It holds
// patches, form factors, materials and the solution; src/page/README.md has its format.
#pragma once

#include <cstddef>
#include <string>

#include "radiosity/base.h"
#include "radiosity/pipeline.h"
#include "radiosity/scene.h"

namespace [[gnu::visibility("default")]] radiosity {

/// Form factors between so many patches are up to 64 MB of codes, which a browser reads, keeps and
/// solves. Those of more are summed over this many nodes, clusters of patches.
inline constexpr std::size_t kMostPageNodes = 8000;
inline constexpr std::size_t kNodesOfMany = 2000;
inline constexpr std::size_t kMostPagePatches = 100000;

struct PageOptions {
  std::string title;
  Camera camera;        ///< the first view
  double exposure = 0;  ///< EV, as autoExposure(): radiance B / pi is multiplied by 2^exposure
  double crease = 30;   ///< degrees; smooth shading shares no values across sharper edges
  /// The file and options by which `radiosity render` draws this light, as a shell reads them;
  /// empty: not known.
  std::string arguments;
  bool heat = false;  ///< with the pipeline's heat(), which is shown first
};

/// The loss of form factors in 16 bits, which hold their logarithms in equal steps.
struct FactorQuantisation {
  double lowest = 0;                  ///< logarithm of the smallest that is kept
  double step = 0;                    ///< code c > 0 stands for exp(lowest + step * c)
  double largest_relative_error = 0;  ///< of one that is kept: exp(step / 2) - 1
  /// The largest sum_j |F_ij as decoded - F_ij| of a row i, including entries left out. An
  /// irradiance may be off by this share of the largest radiosity.
  double largest_row_error = 0;
  /// Pairs with F_ij and F_ji both below 1e-9 / their number, which get code 0.
  std::size_t left_out = 0;
};

struct PageReport {
  std::size_t nodes = 0;  ///< that form factors are summed over; 0: they are between patches
  std::size_t pairs = 0;  ///< form factors kept: one a pair, diagonal included
  FactorQuantisation quantisation;
  std::size_t element_triangles = 0;  ///< of the lit mesh of elements; 0: none
  std::size_t textures = 0;           ///< that surfaces with elements are drawn with
  std::size_t texels = 0;             ///< of all of them, at most 4,194,304
  std::size_t halved_textures = 0;    ///< in each direction, once or more, to be so few
  std::size_t bytes = 0;              ///< of the scene's data, as the browser unpacks it
  std::size_t packed_bytes = 0;       ///< of the same in the file: compressed, as text
};

/// False if the program was built without node and npm, which make the template of a page.
bool canWritePages();

/// Errors: InputError that starts with `name`, with the numbers and the cure, if a page cannot hold
/// that many patches. Form factors are not needed yet.
void requirePageFits(const std::string& name, const PatchMesh& mesh);

/// Writes the page of the pipeline's solution, whole or not at all. `light`: solvedLight() or
/// elementLight(). Errors: as requirePageFits(); InputError if form factors are two estimates a
/// pair, not one (hemicube without symmetrize); RunError if canWritePages() is false or the file
/// cannot be written; Cancelled.
PageReport writePage(const std::string& path, Pipeline& pipeline, const SurfaceLight& light,
                     const PageOptions& options, Progress& progress);

}  // namespace radiosity
