#include "cli/foreign_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/atomic_file.h"
#include "radiosity/interchange.h"
#include "radiosity/results.h"

namespace radiosity::cli {

namespace {

namespace fs = std::filesystem;

struct Program {
  Format format;
  const char* what;
  const char* suffix;  ///< of the names of files beside it
  ForeignScene (*make)(const Scene& scene, const ForeignPicture& picture);
};

constexpr Program kPrograms[] = {{Format::mitsuba, "scene for Mitsuba 3", "-mitsuba", mitsubaScene},
                                 {Format::pbrt, "scene for pbrt-v4", "-pbrt", pbrtScene}};

/// `path`: of the scene; what it names lies beside it.
void writeForeignScene(const ForeignScene& made, const std::string& path, const Program& program,
                       OutputSet& files) {
  const auto beside = [&](const std::string& name) {
    return (fs::path(path).parent_path() / name).string();
  };
  files.write(program.format, program.what,
              [&](const std::string& temporary) { writeWholeFile(temporary, made.text); });
  for (const auto& [name, bytes] : made.files) {
    files.writeBeside(beside(name), "meshes of " + path, [&](const std::string& temporary) {
      writeWholeFile(temporary, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    });
  }
  for (const auto& [name, image] : made.images) {
    files.writeBeside(beside(name), "image of " + path,
                      [&](const std::string& temporary) { writeImage(temporary, image, false); });
  }
}

}  // namespace

bool hasForeignScene(const OutputSet& files) {
  return files.has(Format::mitsuba) || files.has(Format::pbrt);
}

bool onlyForeignScenes(const OutputSet& files) {
  return std::ranges::all_of(files.all(), [](const Output& output) {
    return output.format == Format::mitsuba || output.format == Format::pbrt;
  });
}

void checkForeignScene(const Request& request, const OutputSet& files) {
  for (const Program& program : kPrograms) {
    const std::string path = files.path(program.format);
    if (path.empty()) continue;
    const char* option = !request.show.empty()  ? "--show"
                         : !request.mix.empty() ? "--mix"
                                                : nullptr;
    if (option == nullptr) continue;
    throw InputError(
        fmt::format("{}: is the {}, with its own lamps; leave out {}", path, program.what, option));
  }
}

void writeForeignScenes(Session& session, const Scene& scene, const Picture& picture,
                        OutputSet& files) {
  for (const Program& program : kPrograms) {
    const std::string path = files.path(program.format);
    if (path.empty()) continue;
    const ForeignPicture asked{picture.camera, picture.options.width, picture.options.height,
                               fs::path(path).stem().string() + program.suffix};
    const ForeignScene made = program.make(scene, asked);
    writeForeignScene(made, path, program, files);
    session.report.notes(made.notes);
  }
}

int writeForeignScenesAlone(Session& session, const Scene& scene, const Picture& picture,
                            OutputSet& files) {
  reportPicture(session.report, picture);
  writeForeignScenes(session, scene, picture, files);
  files.commit(session.report, session.progress);
  return 0;
}

}  // namespace radiosity::cli
