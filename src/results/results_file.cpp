// The results file as a whole: its groups and their order.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <new>
#include <span>
#include <utility>

#include "base/atomic_file.h"
#include "base/input_file.h"
#include "base/made.h"
#include "mesh/clusters/cluster_patches.h"
#include "radiosity/results.h"
#include "results/fields.h"
#include "results/h5_reader.h"
#include "results/h5_writer.h"
#include "results/matrix_blocks.h"
#include "results/results_check.h"

namespace radiosity {

namespace {

using h5::FieldReader;
using h5::FieldWriter;
using h5::InputGroup;
using h5::OutputGroup;
using h5::SizeCounter;

constexpr const char* kFormat = "radiosity results";
/// Raised whenever an older program could misread the file.
constexpr std::int32_t kFormatVersion = 7;

/// Writes everything but the matrix and the links into a group or a counter. `suffix`: appended to
/// the names of groups.
template <class Sink>
class StageWriter {
 public:
  StageWriter(Sink& root, const Results& results, std::string suffix = {})
      : root_(root), results_(results), suffix_(std::move(suffix)) {
    if (results.mesh) geometry_hash_ = geometryHash(results.mesh->mesh);
  }

  void head() {
    root_.text("format", kFormat);
    root_.attribute("format_version", h5::Number::i32, 1, &kFormatVersion);
    root_.text("version", results_.version);
  }
  void scene(const Scene& scene) {
    Sink group = root_.group("scene" + suffix_);
    FieldWriter<Sink> fields(group);
    describe(fields, scene);
  }
  Sink mesh(const MeshResult& mesh) {
    Sink group = root_.group("mesh");
    group.text("key", results_.mesh_key);
    group.text("geometry_hash", geometry_hash_);
    FieldWriter<Sink> fields(group);
    describe(fields, mesh.mesh);
    fields.group("report", [&](auto& report) { describe(report, mesh.report); });
    return group;
  }
  Sink factors(const FormFactors& factors) {
    Sink group = root_.group("form_factors");
    group.text("key", results_.factors_key);
    group.text("geometry_hash", geometry_hash_);
    const bool shared = results_.mesh && results_.mesh->mesh.clusters;
    group.text("entry", shared
                            ? "F[i,j]: the fraction of what leaves cluster i that reaches "
                              "cluster j; /mesh/clusters/of_patch names each patch's"
                            : "F[i,j]: the fraction of what leaves patch i that reaches patch j");
    FieldWriter<Sink> fields(group);
    describe(fields, factors);
    return group;
  }
  void solution() {
    if (!results_.solution && !results_.materials) return;
    Sink group = root_.group("solution" + suffix_);
    FieldWriter<Sink> fields(group);
    if (results_.materials) describe(fields, *results_.materials);
    if (!results_.solution) return;
    group.text("key", results_.solution_key);
    describe(fields, *results_.solution);
  }
  void elements() {
    if (!results_.elements) return;
    Sink group = root_.group("elements" + suffix_);
    group.text("key", results_.elements_key);
    FieldWriter<Sink> fields(group);
    describe(fields, *results_.elements);
  }
  void gathered() {
    if (!results_.gathered) return;
    Sink group = root_.group("gather" + suffix_);
    group.text("key", results_.gather_key);
    FieldWriter<Sink> fields(group);
    describe(fields, *results_.gathered);
  }
  void heat() {
    if (!results_.heat) return;
    Sink group = root_.group("heat" + suffix_);
    group.text("key", results_.heat_key);
    FieldWriter<Sink> fields(group);
    describe(fields, *results_.heat);
  }
  void basis() {
    if (!results_.basis) return;
    Sink group = root_.group("basis" + suffix_);
    group.text("key", results_.basis_key);
    FieldWriter<Sink> fields(group);
    describe(fields, *results_.basis);
  }

 private:
  Sink& root_;
  const Results& results_;
  std::string suffix_;
  std::string geometry_hash_;  ///< empty without a mesh
};

/// The arrays of the mesh to which /form_factors links, so that a reader needs no other group:
/// those of the rows, which are patches or clusters.
using MeshLinks = std::span<const std::array<const char*, 2>>;
constexpr std::array<std::array<const char*, 2>, 4> kPatchLinks = {
    {{"normal", "normal"},
     {"centroid", "centroid"},
     {"surface", "surface"},
     {"surface_names", "surface_names"}}};
constexpr std::array<std::array<const char*, 2>, 1> kClusterLinks = {
    {{"of_patch", "clusters/of_patch"}}};

MeshLinks meshLinks(const Results& results) {
  if (!results.mesh) return {};
  if (results.mesh->mesh.clusters) return kClusterLinks;
  return kPatchLinks;
}

void requireMatrix(const std::string& path, const FormFactors* factors) {
  if (factors != nullptr && factors->matrix.size() != factors->fronts.size()) {
    throw RunError(
        fmt::format("{}: the form factors came without their matrix; read them with it", path));
  }
}

/// Refuses rows of a wrong length, which the file would cut short.
void requireRows(const Results& results) {
  if (!results.materials) return;
  const PatchMaterials& materials = *results.materials;
  const auto bands = std::size_t(std::max(materials.bands, 1));
  materials.requireSizes(results.mesh ? results.mesh->mesh.size()
                                      : materials.reflectance.size() / bands);
}

bool isOurs(const InputGroup& root) {
  return root.hasAttribute("format") && root.text("format") == kFormat;
}

void checkHead(const h5::InputFile& file, const InputGroup& root) {
  if (!isOurs(root)) {
    throw InputError(fmt::format(
        "{}: is an HDF5 file of another program; name one written by radiosity", file.path()));
  }
  std::int32_t version = 0;
  root.attribute("format_version", h5::Number::i32, 1, &version);
  if (version != kFormatVersion) {
    throw InputError(fmt::format(
        "{}: has format version {}, this program reads {}; make the file again with this program",
        file.path(), version, kFormatVersion));
  }
  file.requireOwnObjects();
}

FormFactors readFactors(const InputGroup& group, bool with_matrix,
                        std::shared_ptr<ScratchMemory> scratch) {
  FormFactors factors;
  FieldReader fields(group);
  describe(fields, factors);
  if (!with_matrix) return factors;
  factors.matrix = readMatrix(group, std::move(scratch));
  if (factors.matrix.size() != factors.fronts.size()) {
    group.fail("area", fmt::format("has {} patches, fronts has {}", factors.matrix.size(),
                                   factors.fronts.size()));
  }
  return factors;
}

std::optional<Scene> readScene(const InputGroup& root) {
  std::optional<Scene> scene;
  if (root.has("scene")) {
    const InputGroup group = root.group("scene");
    FieldReader fields(group);
    describe(fields, scene.emplace());
  }
  return scene;
}

/// Returns the hash of the mesh that the file names; empty without a mesh.
std::string readStages(const InputGroup& root, bool with_factors,
                       std::shared_ptr<ScratchMemory> scratch, Results& results) {
  results.version = root.text("version");
  results.scene = readScene(root);
  std::string mesh_hash;
  if (root.has("mesh")) {
    const InputGroup group = root.group("mesh");
    results.mesh_key = group.text("key");
    mesh_hash = group.text("geometry_hash");
    FieldReader fields(group);
    describe(fields, results.mesh.emplace().mesh);
    fields.group("report", [&](auto& report) { describe(report, results.mesh->report); });
  }
  if (root.has("form_factors")) {
    const InputGroup group = root.group("form_factors");
    results.factors_key = group.text("key");
    if (results.mesh && group.text("geometry_hash") != mesh_hash) {
      group.fail("geometry_hash", "is not that of /mesh: these form factors are of another mesh");
    }
    results.factors = readFactors(group, with_factors, std::move(scratch));
  }
  if (root.has("solution")) {
    const InputGroup group = root.group("solution");
    FieldReader fields(group);
    if (group.has("reflectance")) describe(fields, results.materials.emplace());
    if (group.has("radiosity")) {
      results.solution_key = group.text("key");
      describe(fields, results.solution.emplace());
    }
  }
  if (root.has("elements")) {
    const InputGroup group = root.group("elements");
    results.elements_key = group.text("key");
    FieldReader fields(group);
    describe(fields, results.elements.emplace());
  }
  if (root.has("gather")) {
    const InputGroup group = root.group("gather");
    results.gather_key = group.text("key");
    FieldReader fields(group);
    describe(fields, results.gathered.emplace());
  }
  if (root.has("heat")) {
    const InputGroup group = root.group("heat");
    results.heat_key = group.text("key");
    FieldReader fields(group);
    describe(fields, results.heat.emplace());
  }
  if (root.has("basis")) {
    const InputGroup group = root.group("basis");
    results.basis_key = group.text("key");
    FieldReader fields(group);
    describe(fields, results.basis.emplace());
  }
  return mesh_hash;
}

std::optional<Scene> sceneAtOnce(const std::string& path) {
  const h5::InputFile file(path);
  const InputGroup root(file);
  checkHead(file, root);
  return readScene(root);
}

Results readAtOnce(const std::string& path, bool with_factors,
                   std::shared_ptr<ScratchMemory> scratch) {
  const h5::InputFile file(path);
  const InputGroup root(file);
  checkHead(file, root);
  Results results;
  std::string mesh_hash;
  try {
    mesh_hash = readStages(root, with_factors, std::move(scratch), results);
  } catch (const std::bad_alloc&) {
    throw RunError(fmt::format("{}: does not fit into memory; use a larger machine", path));
  }
  checkResults(path, results);
  if (results.mesh && geometryHash(results.mesh->mesh) != mesh_hash) {
    file.fail("/mesh/geometry_hash", "is not that of /mesh: another program changed the patches");
  }
  if (results.mesh && results.mesh->mesh.clusters) {
    std::optional<PatchClusters>& clusters = results.mesh->mesh.clusters;
    clusters = clustersOf(std::move(clusters->of_patch), unknownsOf(results.mesh->mesh));
  }
  return results;
}

}  // namespace

bool isResultsFile(const std::string& path) {
  if (!whyNotAFile(path).empty()) return false;
  constexpr std::array<char, 8> kSignature = {'\x89', 'H', 'D', 'F', '\r', '\n', '\x1a', '\n'};
  std::array<char, 8> start{};
  std::ifstream file(path, std::ios::binary);
  return file.read(start.data(), start.size()) && start == kSignature;
}

bool isForeignHdf5(const std::string& path) {
  if (!isResultsFile(path)) return false;
  try {
    return h5::readSettled(path, [&] { return !isOurs(InputGroup(h5::InputFile(path))); });
  } catch (const InputError&) {
    return false;  // damaged, so not ours
  }
}

std::optional<Scene> sceneInResults(const std::string& path) {
  if (!isResultsFile(path)) return std::nullopt;
  try {
    return h5::readSettled(path, [&] { return sceneAtOnce(path); });
  } catch (const InputError&) {
    return std::nullopt;
  }
}

Results readResults(const std::string& path, bool with_factors,
                    std::shared_ptr<ScratchMemory> scratch) {
  return h5::readSettled(path, [&] { return readAtOnce(path, with_factors, scratch); });
}

namespace {

/// `shown`: the form factors to write; null: none.
void writeStages(const std::string& path, const Results& results, const FormFactors* shown,
                 Progress& progress) {
  requireMatrix(path, shown);
  requireRows(results);
  AtomicFile target(path);
  h5::OutputFile file(target.temporary(), path);
  {
    OutputGroup root(file);
    StageWriter<OutputGroup> stages(root, results);
    stages.head();
    if (results.scene) stages.scene(*results.scene);
    std::optional<OutputGroup> mesh;
    if (results.mesh) mesh = stages.mesh(*results.mesh);
    if (shown != nullptr) {
      OutputGroup factors = stages.factors(*shown);
      for (const auto& [name, source] : meshLinks(results)) factors.link(name, made(mesh), source);
      writeMatrix(factors, shown->matrix, progress);
    }
    stages.solution();
    stages.elements();
    stages.gathered();
    stages.heat();
    stages.basis();
  }
  file.close();
  target.commit();
}

}  // namespace

void writeResults(const std::string& path, const Results& results, Progress& progress) {
  writeStages(path, results, results.factors ? &*results.factors : nullptr, progress);
}

void writeResults(const std::string& path, const Results& results, const FormFactors& factors,
                  Progress& progress) {
  writeStages(path, results, &factors, progress);
}

namespace {

/// An extended file is written anew if it is longer than this times its length when last written
/// whole.
constexpr double kMostGrowth = 1.5;
/// The attribute with that length.
constexpr const char* kWholeBytes = "whole_bytes";
constexpr const char* kFresh = ".new";

/// Whether the file has these form factors: another run may have replaced it since the caller
/// looked.
bool isOfTheSameFactors(const OutputGroup& root, const Results& results) {
  if (!root.says("mesh", "key", results.mesh_key)) return false;
  return root.says("form_factors", "key", results.factors_key) &&
         root.says("form_factors", "geometry_hash", geometryHash(made(results.mesh).mesh));
}

}  // namespace

// Replaced stages are removed last: HDF5 could reuse their room, which is before the old end.
bool updateResults(const std::string& path, const Results& results, const StagesAsStored& stored) {
  requireRows(results);
  const std::unique_ptr<h5::OutputFile> file = h5::OutputFile::extend(path);
  if (!file) return false;
  {
    OutputGroup root(*file);
    if (!isOfTheSameFactors(root, results)) return false;
    const std::optional<std::uint64_t> whole = root.number(kWholeBytes);
    if (whole && double(file->oldEnd()) > kMostGrowth * double(*whole)) return false;
    StageWriter<OutputGroup> stages(root, results, kFresh);
    if (!stored.scene && results.scene) stages.scene(*results.scene);
    if (!stored.solution) stages.solution();
    if (!stored.elements) stages.elements();
    if (!stored.gathered) stages.gathered();
    if (!stored.heat) stages.heat();
    if (!stored.basis) stages.basis();
    if (!whole) {
      const std::uint64_t bytes = file->oldEnd();
      root.attribute(kWholeBytes, h5::Number::u64, 1, &bytes);
    }
    const std::pair<const char*, bool> groups[] = {
        {"scene", stored.scene},     {"solution", stored.solution}, {"elements", stored.elements},
        {"gather", stored.gathered}, {"heat", stored.heat},         {"basis", stored.basis}};
    for (const auto& [name, as_stored] : groups) {
      if (as_stored) continue;
      if (root.has(std::string(name) + kFresh)) {
        root.replace(name, std::string(name) + kFresh);
      } else if (root.has(name)) {
        root.remove(name);
      }
    }
  }
  return file->closeExtended();
}

std::size_t estimateResultsBytes(const Results& results) {
  // The superblock, the root, and the unused rest of HDF5's metadata blocks of 2 KiB.
  std::size_t bytes = 2048;
  SizeCounter root(bytes);
  StageWriter<SizeCounter> stages(root, results);
  stages.head();
  if (results.scene) stages.scene(*results.scene);
  if (results.mesh) stages.mesh(*results.mesh);
  if (results.factors) {
    SizeCounter factors = stages.factors(*results.factors);
    for (const auto& link : meshLinks(results)) factors.link(link[0]);
    countMatrix(factors, results.factors->matrix);
  }
  stages.solution();
  stages.elements();
  stages.gathered();
  stages.heat();
  stages.basis();
  return bytes;
}

}  // namespace radiosity
