// The summary of a solution for single lamps.
#include "base/figure_text.h"
#include "cli/section.h"
#include "cli/summaries.h"
#include "cli/words.h"
#include "radiosity/names.h"

namespace radiosity::cli {

void summarizeBasis(Report& report, const LightBasis& basis, Detail detail) {
  const SolveSummary& s = basis.solution.summary;
  if (detail == Detail::brief) report.line("", oneLine(s.message));
  const Section section(report, detail, "basis", "Light of single lamps");
  report.text("status", "status", nameOf(kSolveStatusNames, s.status));
  report.text("solver", "solver", nameOf(kSolverNames, s.solver));
  report.count("sets", "sets", basis.names.size());
  report.number("residual", "residual (relative)", s.residual);
  boundLine(report, s.error_bound);
  report.seconds("seconds", "time", s.seconds);
  const auto bands = std::size_t(basis.bands);
  std::vector<std::vector<std::string>> rows;
  for (std::size_t set = 0; set < basis.names.size(); ++set) {
    double emitted = 0;
    for (std::size_t b = 0; b < bands; ++b) {
      const std::size_t column = set * bands + b;
      emitted += s.energy.emitted[column] + s.energy.from_sky[column];
    }
    rows.push_back({basis.names[set], numberText(emitted)});
  }
  report.table("sources", {{"name", "set", false}, {"emitted_W", "gives, W"}}, rows);
}

}  // namespace radiosity::cli
