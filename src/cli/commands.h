// The subcommands: each takes options, makes the stages, and writes files and a report.
#pragma once

#include "base/processes.h"
#include "cli/outputs.h"
#include "cli/pipeline_report.h"
#include "cli/report.h"
#include "cli/request.h"
#include "cli/time_limit.h"
#include "radiosity/pipeline.h"
#include "radiosity/tables.h"

namespace radiosity::cli {

struct Session {
  const Request& request;
  Report& report;
  Progress& progress;
  const TimeLimit& limit;
  Processes* processes = nullptr;  ///< of mpirun, in process 0; null: there is one process
};

/// The pipeline of one run, with a report of its steps.
struct Run {
  /// Opens the input with the given options. `results_output`: the .h5 that this run writes, or
  /// empty.
  explicit Run(Session& session, const std::string& results_output = {});

  PipelineReport said;
  Pipeline pipeline;
};

// Each returns the exit code: 0, or 1 if the solution is not usable.
int runInfo(Session& session);
int runMesh(Session& session);
int runFactors(Session& session);
int runSolve(Session& session);
int runGather(Session& session);
int runHeat(Session& session);
int runCompare(Session& session);
int runRender(Session& session);
int runIlluminance(Session& session);
int runView(Session& session);

/// Runs in the other processes of mpirun: does the tasks of process 0, which runs the same command.
int serveCommand(const Request& request, Processes& processes);

/// The files that -o names. If there are none and the subcommand is factors, solve, gather or heat,
/// a results file in the input is updated.
OutputSet claimOutputs(const Session& session);

/// Writes the .h5 among `files` with the present stages: once after form factors are computed, and
/// once more with the solution, so that an interrupt in a later stage does not lose them.
void keepFactors(Session& session, Pipeline& pipeline, const OutputSet& files);
void keepSolution(Session& session, Pipeline& pipeline, const OutputSet& files);

/// The same for a run without later stages: the .h5 is written before tables.
void saveResults(Session& session, Pipeline& pipeline, const OutputSet& files);

/// Announces the size of the .mtx among `files`, which are to have one, then writes it.
void writeMatrix(Session& session, const NamedFactors& factors, OutputSet& files);
/// Announces the sizes of the .h5 and .mtx among `files`, then writes them. A results file that
/// would not change is not written.
void writeStages(Session& session, Pipeline& pipeline, OutputSet& files);

/// Writes the .csv of light by patch among `files`.
void writeLightTable(Pipeline& pipeline, const Solution& light, OutputSet& files);
/// Writes the .vtp among `files`, with the subcommand's quantities of each patch; if there is a
/// mixture, with that instead of the solution.
void writeCells(Session& session, Pipeline& pipeline, OutputSet& files,
                const MixedLight* mix = nullptr);

/// Throws InputError, with the cure as a command line to paste, if nothing in the scene emits.
void requireLight(const Session& session, const Pipeline& pipeline);

/// The exit code of a solution: 0 if it is usable, else 1, with a message.
int exitCode(Session& session, bool usable, const std::string& message);
/// Solves, unless that is done already; returns 0 if the solution is usable, else 1, with a
/// message.
int judgeSolution(Session& session, Pipeline& pipeline);

/// Notes that the input is a results file, but new stages are not written to it.
void noteUnsaved(Session& session, const Pipeline& pipeline, const OutputSet& files);

}  // namespace radiosity::cli
