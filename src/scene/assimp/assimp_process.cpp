#include "scene/assimp/assimp_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/side_library.h"
#include "radiosity/base.h"
#include "scene/assimp/assimp_messages.h"

namespace radiosity {

namespace {

constexpr const char* kProgram = "radiosity-assimp";

/// The process, and our end of its sockets. It ends with this object.
class AssimpProcess {
 public:
  AssimpProcess() {
    const std::string program = requiredFileOf(kProgram);
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) failToStart(errno);
    socket_ = ends[0];
    const int error = spawn(program, ends[1]);
    close(ends[1]);
    if (error != 0) {
      close(socket_);
      failToStart(error);
    }
  }
  AssimpProcess(const AssimpProcess&) = delete;
  AssimpProcess& operator=(const AssimpProcess&) = delete;
  ~AssimpProcess() {
    if (process_ > 0) {
      kill(process_, SIGKILL);
      wait();
    }
    close(socket_);
  }

  int socket() const { return socket_; }

  /// Its state at its end, as waitpid() gives it. It gets no further answer.
  int wait() {
    shutdown(socket_, SHUT_RDWR);
    int state = 0;
    while (waitpid(process_, &state, 0) < 0 && errno == EINTR) {
    }
    process_ = 0;
    return state;
  }

 private:
  [[noreturn]] static void failToStart(int error) {
    throw RunError(
        fmt::format("{} cannot be started ({}); free memory or processes, or export the "
                    "scene as .obj or .glb",
                    kProgram, std::strerror(error)));
  }

  /// Nothing that Assimp prints is shown. The error, or 0.
  int spawn(const std::string& program, int end) {
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, end, STDIN_FILENO);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawnattr_init(&attributes);
    sigset_t none;
    sigset_t all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    std::string name = kProgram;
    std::string parent = std::to_string(getpid());
    char* words[] = {name.data(), parent.data(), nullptr};
    const int error = posix_spawn(&process_, program.c_str(), &files, &attributes, words, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    return error;
  }

  pid_t process_ = 0;
  int socket_ = -1;
};

/// Throws what the end of the process means.
[[noreturn]] void failAtEnd(const std::string& file, int state) {
  constexpr int kNotFound = 127;  // of the loader: a library is missing
  const int signal = WIFSIGNALED(state) ? WTERMSIG(state) : 0;
  const int code = WIFEXITED(state) ? WEXITSTATUS(state) : 0;
  if (signal == SIGINT || signal == SIGTERM) throw Cancelled();
  if (code == kNotFound) {
    throw RunError(
        fmt::format("{} cannot be used; install Debian's libassimp5, or export the scene "
                    "as .obj or .glb",
                    RADIOSITY_ASSIMP));
  }
  const char* const why = code == kAssimpOutOfMemory
                              ? "needs far more memory than its size explains"
                          : signal == SIGXCPU ? "takes far longer than its size explains"
                                              : "is damaged";
  throw InputError(
      fmt::format("{}: {}: Assimp, the library that reads this format, gave up; export "
                  "it again, or save it as glTF or OBJ",
                  file, why));
}

/// Whether all indices of the scene are in range.
bool isWhole(const AssimpScene& scene) {
  const auto below = [](std::size_t count) {
    return [count](std::uint32_t index) { return index < count; };
  };
  if (scene.nodes.empty()) return false;
  for (std::size_t k = 0; k < scene.nodes.size(); ++k) {
    const AssimpNode& node = scene.nodes[k];
    if (node.parent >= std::max<std::size_t>(k, 1)) return false;
    if (!std::ranges::all_of(node.meshes, below(scene.meshes.size()))) return false;
  }
  for (const AssimpMesh& mesh : scene.meshes) {
    const std::size_t vertices = mesh.vertices.size();
    const auto fits = [vertices](std::size_t count) { return count == 0 || count == vertices; };
    std::uint64_t corners = 0;
    for (const std::uint32_t count : mesh.corners) corners += count;
    if (mesh.material >= scene.materials.size() || corners != mesh.indices.size() ||
        !fits(mesh.colours.size()) || !fits(mesh.texcoords.size()) ||
        !std::ranges::all_of(mesh.indices, below(vertices))) {
      return false;
    }
  }
  return std::ranges::all_of(scene.materials, [&](const AssimpFileMaterial& material) {
    const bool embeds = material.texture && material.texture->embedded;
    return !embeds || *material.texture->embedded < scene.images.size();
  });
}

std::optional<AssimpScene> sceneOf(const std::string& bytes) {
  try {
    AssimpScene scene;
    AssimpParser parser(bytes);
    passScene(parser, scene);
    if (parser.atEnd() && isWhole(scene)) return scene;
  } catch (const std::runtime_error&) {  // too short
  }
  return std::nullopt;
}

}  // namespace

AssimpAnswer readByAssimp(const std::string& file) {
  AssimpProcess process;
  sendMessage(process.socket(), AssimpMessage::read, file);
  std::string bytes;
  constexpr std::uint64_t kMost = std::uint64_t(1) << 40;  // it may hold far less memory
  const auto answer = receiveMessage(process.socket(), bytes, kMost);
  if (answer == AssimpMessage::cannot_read) return {{}, bytes.empty() ? "no reason" : bytes};
  if (answer == AssimpMessage::scene) {
    if (auto scene = sceneOf(bytes)) return {std::move(*scene), ""};
  }
  failAtEnd(file, process.wait());
}

}  // namespace radiosity
