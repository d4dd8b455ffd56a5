// error_samples scene FILE PATCHES PAIRS | rows FILE PATCHES REFERENCE TOLERANCE... | shapes PAIRS
// SEED: prints samples for error_model.py, a line each, see scene_samples.h, row_samples.h and
// shape_samples.h.
#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "radiosity/patch_mesh.h"
#include "row_samples.h"
#include "scene_samples.h"
#include "shape_samples.h"

namespace radiosity::bench {
namespace {

PatchMesh meshOf(const std::string& file, const std::string& patches) {
  Progress silent;
  MeshOptions options;
  options.patches = std::stoul(patches);
  return meshScene(loadScene(file), options, silent).mesh;
}

bool run(const std::vector<std::string>& words) {
  const auto is = [&](const char* name, std::size_t count) {
    return words.size() >= count && words[0] == name;
  };
  if (is("scene", 4)) {
    sampleScene(meshOf(words[1], words[2]), std::stoul(words[3]));
  } else if (is("rows", 5)) {
    std::vector<double> tolerances;
    for (std::size_t k = 4; k < words.size(); ++k) tolerances.push_back(std::stod(words[k]));
    sampleRows(meshOf(words[1], words[2]), std::stod(words[3]), tolerances);
  } else if (is("shapes", 3)) {
    sampleShapes(std::stoul(words[1]), std::stoul(words[2]));
  } else {
    return false;
  }
  return true;
}

}  // namespace
}  // namespace radiosity::bench

int main(int count, char** values) try {
  if (radiosity::bench::run({values + 1, values + count})) return EXIT_SUCCESS;
  fmt::print(stderr, "error_samples: give scene, rows or shapes; see its first lines\n");
  return 2;
} catch (const std::exception& error) {
  fmt::print(stderr, "error_samples: {}\n", error.what());
  return EXIT_FAILURE;
}
