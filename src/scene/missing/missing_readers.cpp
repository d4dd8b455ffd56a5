// In place of the readers that take packages, where the core is built alone (RADIOSITY_FILES=OFF).
#include <fmt/format.h>

#include "base/file_name.h"
#include "scene/json_scan.h"
#include "scene/readers.h"

namespace radiosity {
namespace {

[[noreturn]] void refuse(const std::string& file, const std::string& what, const char* or_else) {
  throw InputError(
      fmt::format("{}: {} is not read by this build, which is the core alone; build with "
                  "-DRADIOSITY_FILES=ON{}",
                  file, what, or_else));
}

[[noreturn]] void refuseScene(const std::string& path) {
  refuse(path, lowerExtension(path), ", or export the scene as .obj");
}

}  // namespace

Scene loadGltf(const std::string& path, const SceneOptions& /*options*/) { refuseScene(path); }
Scene loadVtk(const std::string& path, const SceneOptions& /*options*/) { refuseScene(path); }
Scene loadVtkXml(const std::string& path, const SceneOptions& /*options*/) { refuseScene(path); }
Scene load3mf(const std::string& path, const SceneOptions& /*options*/) { refuseScene(path); }
Scene loadAssimp(const std::string& path, const SceneOptions& /*options*/) { refuseScene(path); }

void scanJson(const std::string& file, std::string_view /*text*/,
              const std::function<void(std::span<const JsonStep>, const JsonValue&)>& /*visit*/) {
  refuse(file, "JSON", "");
}

}  // namespace radiosity
