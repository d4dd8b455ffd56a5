// Summaries of the stages: figures with their units, on the terminal and in the report.
#pragma once

#include "cli/report.h"
#include "radiosity/elements.h"
#include "radiosity/form_factors.h"
#include "radiosity/gather.h"
#include "radiosity/heat.h"
#include "radiosity/light_basis.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/render.h"
#include "radiosity/scene.h"
#include "radiosity/solve.h"

namespace radiosity::cli {

enum class Detail {
  none,   ///< recorded in the report file only
  brief,  ///< a line on the terminal
  full    ///< every figure on the terminal
};

/// Prints one line on the scene file.
void summarizeScene(Report& report, const Scene& scene, const std::string& from);
/// Prints the output of `radiosity info` for a scene.
void describeScene(Report& report, const Scene& scene);
void summarizeMesh(Report& report, const MeshResult& result, Detail detail);
void summarizeFactors(Report& report, const FormFactors& factors, const PatchMesh& mesh,
                      Detail detail);
/// The bound of the error of B, if there is one.
void boundLine(Report& report, const std::optional<double>& bound);
/// "usable: yes", or what that depends on.
void usableLine(Report& report, bool usable, const FormFactors& factors);
/// `photometric`: whether the lamps are (arePhotometric()).
void summarizeSolution(Report& report, const Solution& solution, const FormFactors& factors,
                       const PatchMesh& mesh, bool photometric, const SolveOptions& options,
                       Detail detail);
/// The summary also names the larger error: that of elements or that of the matrix.
void summarizeElements(Report& report, const Elements& elements, const FormFactors& factors);
/// `sources`: the report of the sources of light at points.
void summarizeFinalGather(Report& report, const ElementReport& sources,
                          const PixelGatherReport& gathered, const FormFactors& factors);
/// heat_summary.cpp
void summarizeHeat(Report& report, const HeatSolution& heat, const FormFactors& factors,
                   const std::vector<SurfaceHeat>& surfaces, const HeatOptions& options,
                   Detail detail);
/// basis_summary.cpp
void summarizeBasis(Report& report, const LightBasis& basis, Detail detail);
void summarizeGathered(Report& report, const Gathered& gathered, const PatchMesh& mesh,
                       const GatherOptions& options, Detail detail);

}  // namespace radiosity::cli
