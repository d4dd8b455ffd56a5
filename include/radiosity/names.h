// The words for values of enums: one table an enum, for the command line, the keys of stages,
// results files, reports and bindings.
#pragma once

#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "radiosity/elements.h"
#include "radiosity/exchange_operator.h"
#include "radiosity/form_factors.h"
#include "radiosity/gather.h"
#include "radiosity/heat.h"
#include "radiosity/lightmap.h"
#include "radiosity/scene.h"
#include "radiosity/solve.h"

namespace [[gnu::visibility("default")]] radiosity {

/// Every value of an enum with its word.
template <class Enum, std::size_t N>
using NameTable = std::array<std::pair<Enum, std::string_view>, N>;

inline constexpr NameTable<Severity, 3> kSeverityNames{
    {{Severity::info, "info"}, {Severity::warning, "warning"}, {Severity::loud, "loud"}}};
inline constexpr NameTable<Up, 2> kUpNames{{{Up::y, "y"}, {Up::z, "z"}}};
inline constexpr NameTable<VertexColours, 3> kVertexColoursNames{{{VertexColours::unused, "off"},
                                                                  {VertexColours::linear, "linear"},
                                                                  {VertexColours::srgb, "srgb"}}};
/// The words of kMethods from `First` to before `End`.
template <std::size_t First, std::size_t End>
constexpr NameTable<FormFactorMethod, End - First> methodNames() {
  NameTable<FormFactorMethod, End - First> names;
  for (std::size_t k = First; k < End; ++k)
    names[k - First] = {kMethods[k].method, kMethods[k].word};
  return names;
}
/// The methods that can be asked for.
inline constexpr auto kMethodNames = methodNames<0, kMethods.size() - 2>();
/// What has made form factors that are there.
inline constexpr auto kFactorsFromNames = methodNames<1, kMethods.size()>();
inline constexpr NameTable<EyeChoice, 3> kEyeNames{
    {{EyeChoice::cpu, "cpu"}, {EyeChoice::gl, "gl"}, {EyeChoice::automatic, "auto"}}};
inline constexpr NameTable<ClosureMode, 3> kClosureNames{{{ClosureMode::off, "off"},
                                                          {ClosureMode::report, "report"},
                                                          {ClosureMode::enforce, "enforce"}}};
inline constexpr NameTable<Precision, 2> kPrecisionNames{
    {{Precision::single_precision, "single"}, {Precision::double_precision, "double"}}};
inline constexpr NameTable<Solver, 7> kSolverNames{{{Solver::automatic, "auto"},
                                                    {Solver::jacobi, "jacobi"},
                                                    {Solver::gauss_seidel, "gauss-seidel"},
                                                    {Solver::cg, "cg"},
                                                    {Solver::gmres, "gmres"},
                                                    {Solver::direct, "direct"},
                                                    {Solver::petsc, "petsc"}}};
inline constexpr NameTable<SolveStatus, 5> kSolveStatusNames{
    {{SolveStatus::converged, "converged"},
     {SolveStatus::no_convergence, "no_convergence"},
     {SolveStatus::no_light, "no_light"},
     {SolveStatus::singular, "singular"},
     {SolveStatus::unbalanced, "unbalanced"}}};
inline constexpr NameTable<HeatStatus, 3> kHeatStatusNames{
    {{HeatStatus::converged, "converged"},
     {HeatStatus::no_convergence, "no_convergence"},
     {HeatStatus::unbalanced, "unbalanced"}}};
inline constexpr NameTable<DirectLight, 5> kDirectLightNames{
    {{DirectLight::none, "none"},
     {DirectLight::exact, "exact"},
     {DirectLight::partly, "partly"},
     {DirectLight::rays, "rays"},
     {DirectLight::hemispheres, "hemispheres"}}};
inline constexpr NameTable<GatherAt, 2> kGatherAtNames{
    {{GatherAt::vertices, "vertices"}, {GatherAt::patches, "patches"}}};

inline constexpr NameTable<LightmapShows, 2> kLightmapShowsNames{
    {{LightmapShows::irradiance, "irradiance"}, {LightmapShows::radiosity, "radiosity"}}};
inline constexpr NameTable<GatherStatus, 4> kGatherStatusNames{
    {{GatherStatus::converged, "converged"},
     {GatherStatus::pass_limit, "pass_limit"},
     {GatherStatus::no_light, "no_light"},
     {GatherStatus::unbalanced, "unbalanced"}}};

// The table of an enum, for the lists of options and reports.
constexpr const auto& tableOf(Solver) { return kSolverNames; }
constexpr const auto& tableOf(SolveStatus) { return kSolveStatusNames; }
constexpr const auto& tableOf(HeatStatus) { return kHeatStatusNames; }
constexpr const auto& tableOf(GatherStatus) { return kGatherStatusNames; }
constexpr const auto& tableOf(DirectLight) { return kDirectLightNames; }
constexpr const auto& tableOf(Up) { return kUpNames; }
constexpr const auto& tableOf(VertexColours) { return kVertexColoursNames; }
constexpr const auto& tableOf(FormFactorMethod) { return kMethodNames; }
constexpr const auto& tableOf(ClosureMode) { return kClosureNames; }
constexpr const auto& tableOf(EyeChoice) { return kEyeNames; }
constexpr const auto& tableOf(Precision) { return kPrecisionNames; }
constexpr const auto& tableOf(GatherAt) { return kGatherAtNames; }
constexpr const auto& tableOf(LightmapShows) { return kLightmapShowsNames; }

/// The word for a value. Throws logic_error if the table lacks it.
template <class Enum, std::size_t N>
std::string nameOf(const NameTable<Enum, N>& table, Enum value) {
  for (const auto& [known, name] : table) {
    if (known == value) return std::string(name);
  }
  throw std::logic_error("a value has no name");
}

/// The value of a word; nothing if the table lacks the word.
template <class Enum, std::size_t N>
std::optional<Enum> named(const NameTable<Enum, N>& table, std::string_view word) {
  for (const auto& [value, name] : table) {
    if (name == word) return value;
  }
  return std::nullopt;
}

/// All words, in the table's order.
template <class Enum, std::size_t N>
std::vector<std::string> namesIn(const NameTable<Enum, N>& table) {
  std::vector<std::string> names;
  names.reserve(N);
  for (const auto& entry : table) names.emplace_back(entry.second);
  return names;
}

}  // namespace radiosity
