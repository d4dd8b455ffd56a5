// The words for what options may be: one table each, for the command line, keys and reports.
#pragma once

#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "radiosity/exchange_matrix.h"
#include "radiosity/form_factors.h"
#include "radiosity/gather.h"
#include "radiosity/solve.h"

namespace radiosity::cli {

template <class Enum, std::size_t N>
using NameTable = std::array<std::pair<Enum, std::string_view>, N>;

inline constexpr NameTable<FormFactorMethod, 3> kMethodNames{
    {{FormFactorMethod::automatic, "auto"},
     {FormFactorMethod::exact, "exact"},
     {FormFactorMethod::hemicube, "hemicube"}}};
inline constexpr NameTable<ClosureMode, 3> kClosureNames{{{ClosureMode::off, "off"},
                                                          {ClosureMode::report, "report"},
                                                          {ClosureMode::enforce, "enforce"}}};
inline constexpr NameTable<Precision, 2> kPrecisionNames{
    {{Precision::single_precision, "single"}, {Precision::double_precision, "double"}}};
inline constexpr NameTable<Solver, 2> kSolverNames{
    {{Solver::gauss_seidel, "gauss-seidel"}, {Solver::jacobi, "jacobi"}}};
inline constexpr NameTable<GatherAt, 2> kGatherAtNames{
    {{GatherAt::vertices, "vertices"}, {GatherAt::patches, "patches"}}};

/// Throws logic_error where the table lacks the value.
template <class Enum, std::size_t N>
std::string nameOf(const NameTable<Enum, N>& table, Enum value) {
  for (const auto& [known, name] : table) {
    if (known == value) return std::string(name);
  }
  throw std::logic_error("an option's value has no name");
}

/// Nothing where the word is none of the table's.
template <class Enum, std::size_t N>
std::optional<Enum> named(const NameTable<Enum, N>& table, std::string_view word) {
  for (const auto& [value, name] : table) {
    if (name == word) return value;
  }
  return std::nullopt;
}

template <class Enum, std::size_t N>
std::vector<std::string> namesIn(const NameTable<Enum, N>& table) {
  std::vector<std::string> names;
  names.reserve(N);
  for (const auto& entry : table) names.emplace_back(entry.second);
  return names;
}

}  // namespace radiosity::cli
