// The results file as a whole: its groups and their order.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <functional>
#include <memory>
#include <new>
#include <span>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "base/input_file.h"
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

/// The arrays of the mesh to which /form_factors links, so that a reader needs no other group.
constexpr std::array kMeshLinks = {"normal", "centroid", "surface", "surface_names"};

/// Writes into a group or a counter. `suffix`: appended to the names of groups.
template <class Sink>
class StageWriter {
 public:
  using PutMatrix = std::function<void(Sink&, const ExchangeOperator&)>;

  StageWriter(Sink& root, const Results& results, std::string suffix = {})
      : root_(root), results_(results), suffix_(std::move(suffix)) {
    if (results.mesh) geometry_hash_ = geometryHash(results.mesh->mesh);
  }

  /// Writes the whole file. `factors`: the form factors in it; null: none.
  void all(const FormFactors* factors, const PutMatrix& put_matrix) {
    root_.text("format", kFormat);
    root_.attribute("format_version", h5::Number::i32, 1, &kFormatVersion);
    root_.text("version", results_.version);
    scene();
    factors_ = factors;
    put_matrix_ = put_matrix;
    forEachStage([this](const auto& stage) { this->write(stage); });
  }
  void scene() {
    if (!results_.scene) return;
    Sink group = root_.group("scene" + suffix_);
    FieldWriter<Sink> fields(group);
    describe(fields, *results_.scene);
  }
  /// Writes the stage if it is there.
  template <class T>
  void write(const StageOf<T>& stage) {
    if (results_.*stage.value) put(stage, *(results_.*stage.value));
  }
  void write(const StageOf<FormFactors>& stage) {
    if (factors_ == nullptr) return;
    Sink group = put(stage, *factors_);
    for (const char* name : kMeshLinks) {
      if (results_.mesh)
        group.link(name, root_, kStage<Stage::mesh>.group + ("/" + std::string(name)));
    }
    put_matrix_(group, *factors_->matrix);
  }
  /// With the materials, which may be there without a solution.
  void write(const StageOf<Solution>& stage) {
    if (!results_.solution && !results_.materials) return;
    Sink group = root_.group(stage.group + suffix_);
    FieldWriter<Sink> fields(group);
    if (results_.materials) describe(fields, *results_.materials);
    if (!results_.solution) return;
    group.text("key", results_.solution.key);
    describe(fields, *results_.solution);
    if (results_.materials) writePhotometric(fields, *results_.materials, *results_.solution);
  }

 private:
  /// For readers of other programs: ours makes these anew.
  static void writePhotometric(FieldWriter<Sink>& fields, const PatchMaterials& materials,
                               const Solution& solution) {
    if (!arePhotometric(materials.lights) || !isPhotometric(solution.bands)) return;
    const PhotometricRows rows = photometricRows(solution);
    fields("illuminance", rows.illuminance, "lx");
    fields("luminance", rows.luminance, "cd/m^2");
  }

  template <class T>
  Sink put(const StageOf<T>& stage, const T& value) {
    Sink group = root_.group(stage.group + suffix_);
    group.text("key", (results_.*stage.value).key);
    putIdentity(group, value);
    FieldWriter<Sink> fields(group);
    describe(fields, value);
    return group;
  }
  template <class T>
  void putIdentity(Sink& /*group*/, const T& /*value*/) {}
  void putIdentity(Sink& group, const MeshResult& /*mesh*/) {
    group.text("geometry_hash", geometry_hash_);
  }
  void putIdentity(Sink& group, const FormFactors& /*factors*/) {
    group.text("geometry_hash", geometry_hash_);
    group.text("entry", "F[i,j]: the fraction of what leaves patch i that reaches patch j");
  }

  Sink& root_;
  const Results& results_;
  std::string suffix_;
  std::string geometry_hash_;  ///< empty without a mesh
  const FormFactors* factors_ = nullptr;
  PutMatrix put_matrix_;
};

void requireMatrix(const std::string& path, const FormFactors* factors) {
  const bool whole =
      factors == nullptr || (factors->matrix && factors->matrix->size() == factors->fronts.size());
  if (!whole) {
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
  if (root.has("mesh") && root.group("mesh").has("clusters")) {
    throw InputError(fmt::format(
        "{}: its patches share unknowns, of which this program knows nothing; make the file again "
        "with this program",
        file.path()));
  }
  file.requireOwnObjects();
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

class StageReader {
 public:
  /// `scratch`: as in readResults().
  StageReader(const InputGroup& root, bool with_factors, std::shared_ptr<ScratchMemory> scratch)
      : root_(root), with_factors_(with_factors), scratch_(std::move(scratch)) {}

  Results all() {
    results_.version = root_.text("version");
    results_.scene = readScene(root_);
    forEachStage([this](const auto& stage) {
      if (root_.has(stage.group)) read(root_.group(stage.group), results_.*stage.value);
    });
    return std::move(results_);
  }
  /// That the file names of its mesh; empty without a mesh.
  const std::string& geometryHash() const { return geometry_hash_; }

 private:
  template <class T>
  void read(const InputGroup& group, Keyed<T>& stage) {
    stage.key = group.text("key");
    FieldReader fields(group);
    describe(fields, stage.value.emplace());
    readMore(group, *stage);
  }
  void read(const InputGroup& group, Keyed<Solution>& solution) {
    FieldReader fields(group);
    if (group.has("reflectance")) describe(fields, results_.materials.emplace());
    if (!group.has("radiosity")) return;
    solution.key = group.text("key");
    describe(fields, solution.value.emplace());
  }
  template <class T>
  void readMore(const InputGroup& /*group*/, const T& /*value*/) {}
  void readMore(const InputGroup& group, const MeshResult& /*mesh*/) {
    geometry_hash_ = group.text("geometry_hash");
  }
  void readMore(const InputGroup& group, FormFactors& factors) {
    if (results_.mesh && group.text("geometry_hash") != geometry_hash_) {
      group.fail("geometry_hash", "is not that of /mesh: these form factors are of another mesh");
    }
    if (!with_factors_) return;
    factors.matrix = readMatrix(group, std::move(scratch_));
    if (factors.matrix->size() == factors.fronts.size()) return;
    group.fail("area", fmt::format("has {} patches, fronts has {}", factors.matrix->size(),
                                   factors.fronts.size()));
  }

  const InputGroup& root_;
  bool with_factors_;
  std::shared_ptr<ScratchMemory> scratch_;
  Results results_;
  std::string geometry_hash_;
};

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
  StageReader stages(root, with_factors, std::move(scratch));
  Results results;
  try {
    results = stages.all();
  } catch (const std::bad_alloc&) {
    throw RunError(fmt::format("{}: does not fit into memory; use a larger machine", path));
  }
  checkResults(path, results);
  if (results.mesh && geometryHash(results.mesh->mesh) != stages.geometryHash()) {
    file.fail("/mesh/geometry_hash", "is not that of /mesh: another program changed the patches");
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
    StageWriter<OutputGroup>(root, results)
        .all(shown, [&](OutputGroup& group, const ExchangeOperator& matrix) {
          writeMatrix(group, matrix, progress);
        });
  }
  file.close();
  target.commit();
}

/// Null: there are none.
const FormFactors* factorsIn(const Results& results) {
  return results.factors ? &*results.factors : nullptr;
}

}  // namespace

void writeResults(const std::string& path, const Results& results, Progress& progress) {
  writeStages(path, results, factorsIn(results), progress);
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

template <class T>
bool isAsStored(const OutputGroup& root, const StageOf<T>& stage, const Results& results) {
  const Keyed<T>& value = results.*stage.value;
  return value && root.says(stage.group, "key", value.key);
}

/// Another run may have replaced the form factors since the caller looked.
bool hasTheFactorsOf(const Results& results, const OutputGroup& root) {
  return isAsStored(root, kStage<Stage::mesh>, results) &&
         isAsStored(root, kStage<Stage::form_factors>, results) &&
         root.says(kStage<Stage::form_factors>.group, "geometry_hash",
                   geometryHash(results.mesh->mesh));
}

/// Puts the group that was written beside the group `name` into its place; if there is none, takes
/// that one out.
void takeOver(OutputGroup& root, const std::string& name) {
  if (root.has(name + kFresh)) {
    root.replace(name, name + kFresh);
  } else if (root.has(name)) {
    root.remove(name);
  }
}

}  // namespace

// Replaced stages are removed last: HDF5 could reuse their room, which is before the old end.
bool updateResults(const std::string& path, const Results& results, bool same_scene) {
  requireRows(results);
  const std::unique_ptr<h5::OutputFile> file = h5::OutputFile::extend(path);
  if (!file) return false;
  {
    OutputGroup root(*file);
    if (!hasTheFactorsOf(results, root)) return false;
    const std::optional<std::uint64_t> whole = root.number(kWholeBytes);
    if (whole && double(file->oldEnd()) > kMostGrowth * double(*whole)) return false;
    StageWriter<OutputGroup> stages(root, results, kFresh);
    std::vector<std::string> written;
    if (!same_scene) {
      stages.scene();
      written.emplace_back("scene");
    }
    forEachStage([&](const auto& stage) {
      if (isAsStored(root, stage, results)) return;
      stages.write(stage);
      written.emplace_back(stage.group);
    });
    if (!whole) {
      const std::uint64_t bytes = file->oldEnd();
      root.attribute(kWholeBytes, h5::Number::u64, 1, &bytes);
    }
    for (const std::string& group : written) takeOver(root, group);
  }
  return file->closeExtended();
}

std::size_t estimateResultsBytes(const Results& results) {
  // The superblock, the root, and the unused rest of HDF5's metadata blocks of 2 KiB.
  std::size_t bytes = 2048;
  SizeCounter root(bytes);
  StageWriter<SizeCounter>(root, results).all(factorsIn(results), countMatrix);
  return bytes;
}

}  // namespace radiosity
