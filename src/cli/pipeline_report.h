// Reports the stages of a run when they are made, one line each.
#pragma once

#include <span>
#include <string>

#include "cli/report.h"
#include "cli/request.h"
#include "cli/summaries.h"
#include "cli/time_limit.h"
#include "radiosity/pipeline.h"

namespace radiosity::cli {

class PipelineReport : public PipelineObserver {
 public:
  /// `writes_results`: the run writes a results file.
  PipelineReport(const Request& request, Report& report, const TimeLimit& limit,
                 bool writes_results)
      : request_(request), report_(report), limit_(limit), writes_results_(writes_results) {}

  void opened(const Pipeline& pipeline) override;
  void notes(const Pipeline& pipeline, std::span<const Note> notes) override;
  void notReused(const std::string& path, const std::string& why) override;
  /// Throws RunError if the plan takes longer than the time limit allows.
  void planned(const Pipeline& pipeline, const FormFactorPlan& plan) override;
  void keepsRows(const Pipeline& pipeline, const std::string& path) override;
  void rows(const Pipeline& pipeline, const std::string& text) override;
  void stage(const Pipeline& pipeline, const StageEvent& event) override;

 private:
  void noteUnused(FormFactorMethod method);
  void summarize(const Pipeline& pipeline, const StageEvent& event);

  const Request& request_;
  Report& report_;
  const TimeLimit& limit_;
  bool writes_results_;
};

}  // namespace radiosity::cli
