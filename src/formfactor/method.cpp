#include "formfactor/method.h"

#include <utility>

namespace radiosity {

FormFactorPlan PreparedMethod::plan(Progress& progress) {
  auto [plan, memory] = foresee(progress);
  memory_ = memory;
  matrix_bytes_ = plan.matrix_bytes;
  plan.method = traits_.method;
  plan.bytes = memory.bytes;
  plan.scratch_bytes = memory.scratch_bytes;
  return plan;
}

RowMemory PreparedMethod::memory(const Processes* processes) const {
  if (processes == nullptr || traits_.counts_rays) return memory_;
  return shareOf(memory_, matrix_bytes_, processes->size());
}

FormFactors PreparedMethod::compute(KnownRows known, Progress& progress, RowJournal* journal,
                                    Processes* processes) const {
  std::optional<std::size_t> known_rows;
  if (roomForExactRows() && !options_.exact_rows.empty()) known_rows = known.rows.size();
  const bool are_exact = known.are_exact;
  const RowMemory held = memory(processes);
  FormFactors result = make(std::move(known), {progress, journal, processes,
                                               makeRowMemory(held, options_, mesh_.size())});
  result.method = traits_.method;
  result.report.polygons = mesh_.polygons.size();
  result.report.estimated_bytes = held.bytes;
  (are_exact ? result.report.exact_rows : result.report.shadow_rows) = known_rows;
  return result;
}

std::shared_ptr<const ExchangeMatrix> PreparedMethod::computeForOthers(Processes& processes,
                                                                       Progress& progress,
                                                                       RowJournal* journal) const {
  return share({progress, journal, &processes});
}

}  // namespace radiosity
