// The work of processes other than number 0 under mpirun.
#include <memory>

#include "cli/commands.h"

namespace radiosity::cli {

namespace {

/// Opens the scene when it is first needed: by then process 0 has read it without a fault.
class OpenedScene {
 public:
  explicit OpenedScene(const Request& request)
      : report_(true), limit_(kNoTimeLimit), session_{request, report_, progress_, limit_} {
    report_.mute(true);
  }
  Pipeline& pipeline() {
    if (!run_) run_ = std::make_unique<Run>(session_);
    return run_->pipeline;
  }

 private:
  Report report_;
  Progress progress_;
  TimeLimit limit_;
  Session session_;
  std::unique_ptr<Run> run_;
};

}  // namespace

int serveCommand(const Request& request, Processes& processes) {
  setThreads(request.threads);
  OpenedScene scene(request);
  for (;;) {
    SharedTask task = SharedTask::end;
    processes.broadcastValue(task);
    switch (task) {
      case SharedTask::mesh:
      case SharedTask::form_factors:
      case SharedTask::stored_matrix:
        scene.pipeline().serve(processes, task);
        break;
      case SharedTask::end:
        processes.finish();
        return 0;
    }
  }
}

}  // namespace radiosity::cli
