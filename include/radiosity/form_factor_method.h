// The methods by which form factors are made, and what others need to know of each.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>

#include "radiosity/base.h"
#include "radiosity/spelling.h"

namespace [[gnu::visibility("default")]] radiosity {

/// What makes, or has made, form factors.
enum class FormFactorMethod {
  automatic,  ///< exact, or rays or cut, as a sample of rows decides; the report says why
  exact,      ///< area to area, with blocked parts clipped off
  rays,       ///< area to area, by counting cosine-distributed rays
  cut,        ///< the same without pairs: rows cut through a tree of patches
  hemicube,   ///< seen from one eye at each patch's centroid (Cohen & Greenberg 1985)
  matrix,     ///< given as a matrix (factorsOfMatrix())
  file        ///< read from a file of form factors alone (factorsOfFile())
};

struct MethodTraits {
  FormFactorMethod method;
  std::string_view word;       ///< on the command line, in keys, files and reports
  std::string_view summary{};  ///< what it computes; empty: it cannot be asked for
  /// The words of options that it uses and others may not, as keys have them.
  std::array<std::string_view, 8> options{};
  double tolerance = 0;   ///< FormFactorOptions::tolerance by default; 0: it has none
  bool symmetric = true;  ///< A_i F_ij = A_j F_ji, without FormFactorOptions::symmetrize
  /// Rows are made by process 0 out of what all processes count. Of others each is made in one
  /// process.
  bool counts_rays = false;
  /// Whether it gives F_ij pair by pair (ExchangeMatrix).
  bool stores_pairs = true;
  /// The share of its light that an energy account may be off, and the cure if it is off by more.
  double imbalance = std::numeric_limits<double>::infinity();
  std::string (*cure)() = [] { return std::string(); };

  /// What no method names is for all, and `automatic` may come to use any.
  constexpr bool uses(std::string_view option) const;
};

inline std::string cureOfMatrix() {
  return "correct the matrix, or its areas (" + spelled("areas") + ")";
}

inline constexpr std::array kMethods{
    MethodTraits{.method = FormFactorMethod::automatic,
                 .word = "auto",
                 .summary =
                     "exact, or rays, or cut for many patches, by what a sample of rows takes; "
                     "the report says why"},
    // Rows are off 1 by rounding and tolerance, and bright rooms multiply that.
    MethodTraits{.method = FormFactorMethod::exact,
                 .word = "exact",
                 .summary = "area to area, hidden parts clipped off",
                 .options = {"tolerance", "closure"},
                 .tolerance = 1e-3,
                 .imbalance = 0.005,
                 .cure =
                     [] {
                       return "give " + spelled("closure", "enforce") + ", or a smaller " +
                              spelled("tolerance");
                     }},
    MethodTraits{.method = FormFactorMethod::rays,
                 .word = "rays",
                 .summary = "area to area, by counting rays",
                 .options = {"tolerance", "closure", "seed"},
                 .tolerance = 1e-2,
                 .counts_rays = true,
                 .imbalance = 0.005,
                 .cure =
                     [] {
                       return "give a smaller " + spelled("tolerance") + ", or " +
                              spelled("method", "exact");
                     }},
    MethodTraits{.method = FormFactorMethod::cut,
                 .word = "cut",
                 .summary = "by rays, without pairs: rows cut through a tree of many patches",
                 .options = {"tolerance", "seed"},
                 .tolerance = 2e-2,
                 .symmetric = false,
                 .counts_rays = true,
                 .stores_pairs = false,
                 .imbalance = 0.005,
                 .cure =
                     [] {
                       return "give a smaller " + spelled("tolerance") + ", or " +
                              spelled("method", "rays");
                     }},
    // A patch is represented by a point: form factors are off by 8% to 30%
    // (src/formfactor/README.md), and an account sums over many of them.
    MethodTraits{.method = FormFactorMethod::hemicube,
                 .word = "hemicube",
                 .summary = "seen from one point a patch",
                 .options = {"seed", "resolution", "symmetrize", "near", "random-turns", "eye"},
                 .symmetric = false,
                 .imbalance = 0.1,
                 .cure =
                     [] {
                       return "give " + spelled("symmetrize") + ", a higher " +
                              spelled("resolution") + ", or " + spelled("method", "exact");
                     }},
    MethodTraits{.method = FormFactorMethod::matrix, .word = "matrix", .cure = cureOfMatrix},
    MethodTraits{.method = FormFactorMethod::file, .word = "file", .cure = cureOfMatrix}};

constexpr bool MethodTraits::uses(std::string_view option) const {
  const auto names = [option](const MethodTraits& one) {
    return std::find(one.options.begin(), one.options.end(), option) != one.options.end();
  };
  return method == FormFactorMethod::automatic || names(*this) ||
         std::none_of(kMethods.begin(), kMethods.end(), names);
}

/// The methods that `automatic` chooses from, the most accurate one first.
inline constexpr std::array kAutomaticChoices{FormFactorMethod::exact, FormFactorMethod::rays,
                                              FormFactorMethod::cut};

constexpr const MethodTraits& traitsOf(FormFactorMethod method) {
  for (const MethodTraits& traits : kMethods) {
    if (traits.method == method) return traits;
  }
  throw std::logic_error("a method without traits");
}

}  // namespace radiosity
