#include "cli/desktop.h"

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include <cstdlib>

namespace radiosity::cli {

namespace {

bool hasDisplay() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"}) {
    const char* value = std::getenv(name);
    if (value != nullptr && *value != '\0') return true;
  }
  return false;
}

/// Silences the output of the browser, which does not belong to the report.
class Silence {
 public:
  Silence() {
    posix_spawn_file_actions_init(&actions_);
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) {
      posix_spawn_file_actions_addopen(&actions_, stream, "/dev/null", O_WRONLY, 0);
    }
  }
  ~Silence() { posix_spawn_file_actions_destroy(&actions_); }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;
  const posix_spawn_file_actions_t* actions() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

}  // namespace

bool openInDesktop(const std::string& path) {
  if (isatty(STDOUT_FILENO) == 0 || !hasDisplay()) return false;
  const Silence silence;
  std::string name = "xdg-open";
  std::string file = path;
  char* arguments[] = {name.data(), file.data(), nullptr};
  pid_t child = 0;
  return posix_spawnp(&child, name.c_str(), silence.actions(), nullptr, arguments, environ) == 0;
}

}  // namespace radiosity::cli
