#include "radiosity/form_factors.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/figure_text.h"
#include "base/option_list.h"
#include "base/processor_clock.h"
#include "formfactor/automatic_choice.h"
#include "formfactor/emitter_rows.h"
#include "formfactor/method.h"
#include "formfactor/row_accounts.h"
#include "formfactor/shared_factors.h"
#include "radiosity/spelling.h"

namespace radiosity {

struct FormFactorPlan::Prepared {
  std::shared_ptr<const PatchMesh> mesh;
  FormFactorOptions options;
  std::unique_ptr<const PreparedMethod> method;
  std::unique_ptr<const EmitterRows> emitters;  ///< computed beside the method; null: none
  double seconds = 0;                           ///< of all this
};

namespace {

void requirePatches(const std::vector<Index>& rows, std::size_t patches) {
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (rows[k] < patches && (k == 0 || rows[k - 1] < rows[k])) continue;
    throw InputError(
        fmt::format("exact_rows[{}] = {}: give patches in ascending order, each once and below {}",
                    k, rows[k], patches));
  }
}

void noteRowsThatAreNotExact(const FormFactorPlan& plan, FormFactorReport& report) {
  const FormFactorPlan::Prepared& prepared = *plan.prepared;
  const std::size_t wanted = prepared.options.exact_rows.size();
  if (wanted == 0 || !prepared.method->roomForExactRows()) return;
  if (prepared.emitters && prepared.emitters->areExact()) return;
  const std::string way =
      prepared.emitters ? "shadow rays"
                        : fmt::format("the method {}, as all others", traitsOf(plan.method).word);
  report.notes.push_back(
      {Severity::info,
       fmt::format("rows of the {} {} by {}: exact ones would take too long", countText(wanted),
                   wanted == 1 ? "patch that emits are" : "patches that emit are", way)});
}

/// The same method where its own rows have to bring what emits, too.
Chosen plannedForLamps(Chosen before, const PatchMesh& mesh, FormFactorOptions options,
                       Progress& progress) {
  options.exact_rows.clear();
  Chosen chosen{prepareMethod(before.plan.method, mesh, options), {}};
  chosen.plan = chosen.method->plan(progress);
  chosen.plan.reason = std::move(before.plan.reason);
  chosen.plan.other = before.plan.other;
  return chosen;
}

}  // namespace

void FormFactorOptions::validate() const {
  requireRanges(*this);
  if (traitsOf(method).summary.empty()) {
    throw InputError(fmt::format("method {}: computes nothing", traitsOf(method).word));
  }
  if (needs_pairs && !traitsOf(method).stores_pairs) {
    throw InputError(
        fmt::format("method {}: has no form factors pair by pair, which a page and a matrix "
                    "in a file are made of; give {} or rays",
                    traitsOf(method).word, spelled("method", "exact")));
  }
}

Precision FormFactorOptions::storedPrecision() const {
  // Single precision rounds to 6e-8 of a value, well below a tolerance of 1e-6 of the mean.
  return precision.value_or(tolerance.value_or(kExactTolerance) < 1e-6
                                ? Precision::double_precision
                                : Precision::single_precision);
}

double FormFactorPlan::secondsIfLooser(double times) const {
  return seconds * (1 - refining * (1 - std::pow(times, -refining_order)));
}

FormFactorPlan planFormFactors(const PatchMesh& mesh, const FormFactorOptions& options,
                               Progress& progress) {
  return planFormFactors(std::make_shared<const PatchMesh>(mesh), options, progress);
}

FormFactorPlan planFormFactors(std::shared_ptr<const PatchMesh> mesh,
                               const FormFactorOptions& options, Progress& progress) {
  if (!mesh) throw std::logic_error("planFormFactors(): no mesh");
  options.validate();
  requirePatches(options.exact_rows, mesh->size());
  const Stopwatch watch;
  FormFactorOptions used = options;
  Chosen chosen;
  if (used.method == FormFactorMethod::automatic) {
    chosen = chooseMethod(*mesh, used, progress);
  } else {
    chosen.method = prepareMethod(used.method, *mesh, used);
    chosen.plan = chosen.method->plan(progress);
  }
  auto& [method, plan] = chosen;
  if (!used.knowsEmitters(plan.method)) used.exact_rows.clear();
  auto emitters = EmitterRows::planned(*mesh, used, *method, plan, progress);
  if (!emitters && !used.exact_rows.empty() && plan.method == FormFactorMethod::cut) {
    chosen = plannedForLamps(std::move(chosen), *mesh, used, progress);
  }
  plan.prepared = std::make_shared<FormFactorPlan::Prepared>(FormFactorPlan::Prepared{
      std::move(mesh), std::move(used), std::move(method), std::move(emitters), watch.seconds()});
  return std::move(plan);
}

namespace {

/// Form factors in place of exact ones that were given up after `seconds`.
FormFactors computeInstead(const FormFactorPlan& exact, double seconds, Progress& progress) {
  FormFactorOptions options = exact.prepared->options;
  options.method = planBesideExact(*exact.prepared->mesh, options, progress).plan.method;
  FormFactorPlan plan = planFormFactors(exact.prepared->mesh, options, progress);
  plan.reason = overrunText(exact.seconds, seconds);
  FormFactors result = computeFormFactors(plan, progress);
  result.report.notes.push_back(
      {Severity::info, fmt::format("form factors by the method {}: {}",
                                   traitsOf(options.method).word, plan.reason)});
  result.report.seconds += exact.prepared->seconds + seconds;
  return result;
}

}  // namespace

FormFactors computeFormFactors(const FormFactorPlan& plan, Progress& progress, RowJournal* journal,
                               Processes* processes) {
  const Stopwatch watch;
  if (!plan.prepared) throw std::logic_error("this plan is not from planFormFactors()");
  const FormFactorPlan::Prepared& prepared = *plan.prepared;
  const PreparedMethod& method = *prepared.method;
  if (processes != nullptr) {
    tellOthers(*processes, *prepared.mesh, plan.method, prepared.options);
  }
  // One process alone cannot give up shared work.
  const bool may_give_up = processes == nullptr && plan.method == FormFactorMethod::exact &&
                           prepared.options.method == FormFactorMethod::automatic;
  FormFactors result;
  if (may_give_up) {
    std::optional<FormFactors> in_time = computeInTime(method, plan.seconds, progress, journal);
    if (!in_time) return computeInstead(plan, watch.seconds(), progress);
    result = *std::move(in_time);
  } else {
    KnownRows known = prepared.emitters ? prepared.emitters->compute(progress) : KnownRows();
    result = method.compute(std::move(known), progress, journal, processes);
  }
  FormFactorReport& report = result.report;
  noteRowsThatAreNotExact(plan, report);
  if (result.seeNothing()) {
    if (std::optional<Note> note = nothingSeenNote(*prepared.mesh)) {
      report.notes.push_back(*std::move(note));
    }
  }
  report.method_reason = plan.reason;
  // What was prepared for the method is part of its work.
  const double preparing =
      method.secondsPreparing() + (prepared.emitters ? prepared.emitters->secondsPreparing() : 0.0);
  report.seconds_plan = prepared.seconds - preparing;
  report.estimated_seconds = preparing + plan.seconds;
  report.matrix_bytes = result.matrix->bytes();
  report.seconds = prepared.seconds + watch.seconds();
  return result;
}

FormFactors computeFormFactors(const PatchMesh& mesh, const FormFactorOptions& options,
                               Progress& progress) {
  // The mesh outlives the plan, which ends with this call: it is not copied.
  const std::shared_ptr<const PatchMesh> here(std::shared_ptr<const void>(), &mesh);
  return computeFormFactors(planFormFactors(here, options, progress), progress);
}

}  // namespace radiosity
