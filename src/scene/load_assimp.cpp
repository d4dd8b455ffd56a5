// What Assimp reads and we do not: Collada, FBX, 3DS, X3D. Nodes are objects, diffuse and
// emissive colours are read as those of an MTL file.
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <numbers>

#include "base/finite.h"
#include "base/input_file.h"
#include "base/srgb.h"
#include "scene/assimp_library.h"
#include "scene/mesh_cursor.h"
#include "scene/readers.h"
#include "scene/scene_builder.h"
#include "scene/text.h"

namespace radiosity {

namespace {

class AssimpReader {
 public:
  AssimpReader(const std::string& path, const SceneOptions& options)
      : options_(options), builder_(scene_) {
    scene_.file = path;
  }

  Scene read() {
    const std::unique_ptr<aiPropertyStore, void (*)(aiPropertyStore*)> wishes(
        library_.createPropertyStore(), library_.releasePropertyStore);
    // Names as people gave them, not ids.
    library_.setImportPropertyInteger(wishes.get(), AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, 1);
    const std::unique_ptr<const aiScene, void (*)(const aiScene*)> file(
        library_.importFileExWithProperties(scene_.file.c_str(), aiProcess_ValidateDataStructure,
                                            nullptr, wishes.get()),
        library_.releaseImport);
    if (file == nullptr || file->mRootNode == nullptr) {
      fail(fmt::format("cannot be read ({}); export it again, or as .obj or .glb",
                       onOneLine(library_.getErrorString())));
    }
    for (unsigned m = 0; m < file->mNumMaterials; ++m) addMaterial(*file->mMaterials[m], m);
    scale_ = metresPerUnit(*file);
    addNodes(*file);
    if (scene_.faceCount() == 0) fail("no faces; export the scene with its meshes as polygons");
    if (file->mNumLights > 0) {
      scene_.notes.push_back({Severity::warning,
                              "lights without a surface are left out; make a "
                              "surface a lamp by --set NAME.radiance=10"});
    }
    notes_.appendTo(scene_.notes);
    builder_.finish();
    return std::move(scene_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", scene_.file, what));
  }

  void addMaterial(const aiMaterial& given, unsigned number);
  Vec3 colour(const aiMaterial& given, const char* key, const Vec3& otherwise) const;
  std::string objectName(const aiNode& node, const aiMesh& mesh) const;
  static double metresPerUnit(const aiScene& file);
  void addNodes(const aiScene& file);
  void addMesh(const aiMesh& mesh, const std::string& object, const aiMatrix4x4& place);

  const SceneOptions& options_;
  const AssimpLibrary& library_ = assimpLibrary();
  Scene scene_;
  SceneBuilder builder_;
  UniqueNames material_names_;
  FeatureNotes notes_;
  double scale_ = 1;
};

// Keys of materials are written out where AI_MATKEY macros give three arguments at once.

Vec3 AssimpReader::colour(const aiMaterial& given, const char* key, const Vec3& otherwise) const {
  aiColor4D found;
  if (library_.getMaterialColor(&given, key, 0, 0, &found) != AI_SUCCESS) return otherwise;
  return {double(found.r), double(found.g), double(found.b)};
}

void AssimpReader::addMaterial(const aiMaterial& given, unsigned number) {
  aiString text;
  std::string name;
  if (library_.getMaterialString(&given, AI_MATKEY_NAME, &text) == AI_SUCCESS) name = text.C_Str();
  // Assimp makes up a grey material for meshes without one.
  if (name == AI_DEFAULT_MATERIAL_NAME) {
    scene_.materials.push_back(defaultMaterial(material_names_.make("default"), options_));
    return;
  }
  if (name.empty()) name = fmt::format("material {}", number);
  Material material = defaultMaterial(material_names_.make(name), options_);
  material.reflectance = colour(given, "$clr.diffuse", material.reflectance);
  const Vec3 radiance = colour(given, "$clr.emissive", Vec3(0.0));
  checkReflectance(scene_.file, material.name, material.reflectance);
  checkEmission(scene_.file, material.name, radiance);
  if (options_.kd_is_srgb) {
    for (int band = 0; band < 3; ++band) {
      material.reflectance[band] = linearFromSrgb(material.reflectance[band]);
    }
  }
  material.emission = std::numbers::pi * radiance;
  int two_sided = 0;
  if (library_.getMaterialIntegerArray(&given, AI_MATKEY_TWOSIDED, &two_sided, nullptr) ==
      AI_SUCCESS) {
    material.two_sided = two_sided != 0;
  }
  if (library_.getMaterialTextureCount(&given, aiTextureType_DIFFUSE) > 0) {
    notes_.add("textures of this format are not read, the colour alone counts", material.name,
               Severity::warning);
  }
  scene_.materials.push_back(std::move(material));
}

/// Assimp makes up names in angle brackets.
std::string AssimpReader::objectName(const aiNode& node, const aiMesh& mesh) const {
  for (const aiString* name : {&node.mName, &mesh.mName}) {
    if (name->length > 0 && name->data[0] != '<') return name->C_Str();
  }
  return std::filesystem::path(scene_.file).stem().string();
}

/// FBX says how many centimetres its unit has; Collada's is in its root node.
double AssimpReader::metresPerUnit(const aiScene& file) {
  double centimetres = 0;
  float single = 0;
  if (file.mMetaData == nullptr) return 1;
  if (file.mMetaData->Get("UnitScaleFactor", centimetres)) return centimetres / 100;
  if (file.mMetaData->Get("UnitScaleFactor", single)) return double(single) / 100;
  return 1;
}

/// All nodes, each before its children. (No recursion: a file may have chains of any length.)
void AssimpReader::addNodes(const aiScene& file) {
  std::vector<std::pair<const aiNode*, aiMatrix4x4>> open = {{file.mRootNode, aiMatrix4x4()}};
  while (!open.empty()) {
    const auto [node, above] = open.back();
    open.pop_back();
    const aiMatrix4x4 place = above * node->mTransformation;
    for (unsigned k = 0; k < node->mNumMeshes; ++k) {
      const aiMesh& mesh = *file.mMeshes[node->mMeshes[k]];
      addMesh(mesh, objectName(*node, mesh), place);
    }
    for (unsigned k = node->mNumChildren; k-- > 0;) open.emplace_back(node->mChildren[k], place);
  }
}

void AssimpReader::addMesh(const aiMesh& mesh, const std::string& object,
                           const aiMatrix4x4& place) {
  const std::size_t first = scene_.vertices.size();
  if (first + mesh.mNumVertices >= kNone) fail("too many vertices; split the scene");
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiVector3D p = place * mesh.mVertices[v];
    scene_.vertices.push_back(scale_ * Vec3(double(p.x), double(p.y), double(p.z)));
    if (!isFinite(scene_.vertices.back())) {
      fail(fmt::format("object {}: a coordinate is not a finite number; export it again", object));
    }
  }
  const bool mirrors = place.Determinant() < 0;
  const Index surface = builder_.surface(object, mesh.mMaterialIndex);
  std::vector<Index> corners;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices < 3) {
      notes_.add("lines and points have no area and are left out, in", object);
      continue;
    }
    corners.clear();
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      corners.push_back(Index(first + face.mIndices[mirrors ? face.mNumIndices - 1 - k : k]));
    }
    builder_.addFace(corners, {}, surface, f);
  }
}

}  // namespace

namespace {

/// Assimp reads what is left of a 3DS file as if it were whole: its first chunk says how long it
/// is.
void requireWhole3ds(const std::string& path) {
  if (lowerCase(std::filesystem::path(path).extension().string()) != ".3ds") return;
  const std::string content = readWholeFile(path);
  MeshCursor cursor(path, content);
  cursor.setEncoding(Encoding::little);
  constexpr long long kMainChunk = 0x4D4D;
  if (cursor.integer(NumberType::u16, "chunk") != kMainChunk) {
    throw InputError(path + ": is no 3DS file; export it again");
  }
  const long long length = cursor.integer(NumberType::u32, "length");
  if (length > static_cast<long long>(content.size())) {
    throw InputError(
        fmt::format("{}: is cut off: it says that it has {} bytes and has {}; export it "
                    "again",
                    path, length, content.size()));
  }
}

}  // namespace

Scene loadAssimp(const std::string& path, const SceneOptions& options) {
  requireWhole3ds(path);
  return AssimpReader(path, options).read();
}

}  // namespace radiosity
