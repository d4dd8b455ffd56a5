// The subcommands: options in, one walk through the stages, files and a report out.
#pragma once

#include "base/processes.h"
#include "cli/outputs.h"
#include "cli/pipeline_report.h"
#include "cli/report.h"
#include "cli/request.h"
#include "cli/time_limit.h"
#include "radiosity/pipeline.h"

namespace radiosity::cli {

struct Session {
  const Request& request;
  Report& report;
  Progress& progress;
  const TimeLimit& limit;
  Processes* processes = nullptr;  ///< those of mpirun, in number 0; null: this one alone
};

/// The pipeline of one run, whose steps are reported.
struct Run {
  /// Opens the input with the options given. `results_output`: the .h5 this run writes, or empty.
  explicit Run(Session& session, const std::string& results_output = {});

  PipelineReport said;
  Pipeline pipeline;
};

// Each returns the exit code: 0, or 1 where the solution is not usable.
int runInfo(Session& session);
int runMesh(Session& session);
int runFactors(Session& session);
int runSolve(Session& session);
int runGather(Session& session);
int runHeat(Session& session);
int runCompare(Session& session);
int runRender(Session& session);
int runView(Session& session);

/// In the other processes of mpirun: does what number 0, which runs the same command, asks for.
int serveCommand(const Request& request, Processes& processes);

/// The files -o names; a results file that came in is updated where none is named and the
/// subcommand is factors, solve, gather or heat.
OutputSet claimOutputs(const Session& session);

/// Writes the .h5 among `files` with the stages there are: after form factors were computed, and
/// once more with the solution. An interrupt in a later stage does not lose them.
void keepFactors(Session& session, Pipeline& pipeline, const OutputSet& files);
void keepSolution(Session& session, Pipeline& pipeline, const OutputSet& files);

/// The same for a run that makes no later stage: the .h5 is there before tables are written.
void saveResults(Session& session, Pipeline& pipeline, const OutputSet& files);

/// Writes the .mtx among `files`, after saying how large it will be.
void writeMatrix(Session& session, Pipeline& pipeline, OutputSet& files);
/// Writes the .h5 and .mtx among `files`, after saying how large they will be. A results file
/// that would not change is left alone.
void writeStages(Session& session, Pipeline& pipeline, OutputSet& files);

/// Writes the .csv of light by patch among `files`.
void writeLightTable(Pipeline& pipeline, const Solution& light, OutputSet& files);
/// Writes the .vtp among `files`, with what the subcommand knows of each patch; of a mixture, where
/// there is one, instead of the solution.
void writeCells(Session& session, Pipeline& pipeline, OutputSet& files,
                const MixedLight* mix = nullptr);

/// InputError, with the cure as a command line to paste, where nothing in the scene emits.
void requireLight(const Session& session, const Pipeline& pipeline);

/// The exit code of a solution: 0 where it is usable, else 1, after saying why.
int exitCode(Session& session, bool usable, const std::string& message);
/// Solves, where that was not done; 0 where the solution is usable, else 1, after saying why.
int judgeSolution(Session& session, Pipeline& pipeline);

/// Says so where a results file was the input, more was computed than it holds, and nothing is
/// written to it.
void noteUnsaved(Session& session, const Pipeline& pipeline, const OutputSet& files);

}  // namespace radiosity::cli
