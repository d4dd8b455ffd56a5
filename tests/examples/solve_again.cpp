// Makes what is missing in a results file: solve_again SCENE RESULTS.h5. Run it twice.
#include <radiosity/radiosity.h>

#include <cstdio>

using namespace radiosity;

namespace {

/// Says which stages were reused.
class Console : public PipelineObserver {
  void stage(const Pipeline& /*pipeline*/, const StageEvent& event) override {
    const bool reused = event.action == StageAction::reused;
    std::printf("stage %d: %s\n", int(event.stage), reused ? "reused" : "made");
  }
};

}  // namespace

int main(int, char** arguments) try {
  Progress quiet;
  Console console;
  Pipeline pipeline(quiet, &console);
  pipeline.open(arguments[1], {}, arguments[2]);
  pipeline.options().mesh.patches = 200;
  std::printf("%s\n", pipeline.solution().summary.message.c_str());
  pipeline.save(arguments[2]);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
