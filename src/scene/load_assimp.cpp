// What Assimp reads and we do not: Collada, FBX, 3DS, X3D, IFC. Nodes are objects.
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <map>
#include <memory>
#include <numbers>
#include <string_view>

#include "base/file_name.h"
#include "base/finite.h"
#include "base/input_file.h"
#include "scene/assimp_library.h"
#include "scene/assimp_materials.h"
#include "scene/mesh_cursor.h"
#include "scene/readers.h"
#include "scene/scene_builder.h"
#include "scene/text.h"
#include "scene/xml_preflight.h"

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
        library_.importFileExWithProperties(
            scene_.file.c_str(), aiProcess_ValidateDataStructure | aiProcess_TransformUVCoords,
            nullptr, wishes.get()),
        library_.releaseImport);
    if (file == nullptr || file->mRootNode == nullptr) {
      fail(fmt::format("cannot be read ({}); export it again, or as .obj or .glb",
                       onOneLine(library_.getErrorString())));
    }
    materials_ = readAssimpMaterials(*file, options_, scene_, notes_);
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
    // In all of these formats a texture stands in place of the colour.
    for (Material& material : scene_.materials) {
      if (material.texture != kNone) material.reflectance = Vec3(1.0);
    }
    return std::move(scene_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", scene_.file, what));
  }

  std::string objectName(const aiNode& node, const aiMesh& mesh) const;
  static double metresPerUnit(const aiScene& file);
  void addNodes(const aiScene& file);
  void addMesh(const aiMesh& mesh, const std::string& object, const aiMatrix4x4& place);
  void addCamera(const aiCamera& given, const aiMatrix4x4& place);

  const SceneOptions& options_;
  const AssimpLibrary& library_ = assimpLibrary();
  Scene scene_;
  SceneBuilder builder_;
  std::vector<AssimpMaterial> materials_;  ///< by number in the file
  FeatureNotes notes_;
  double scale_ = 1;
};

/// Assimp makes up names in angle brackets, and calls what an IFC file has in several places, such
/// as a window, as the kind of reference: there the node above has the name.
std::string AssimpReader::objectName(const aiNode& node, const aiMesh& mesh) const {
  constexpr std::string_view kReference = "IfcMappedItem";
  const aiNode* named = &node;
  while (named->mParent != nullptr && named->mName.C_Str() == kReference) named = named->mParent;
  for (const aiString* name : {&named->mName, &mesh.mName}) {
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
  std::multimap<std::string, const aiCamera*> camera_of;  // by the node that holds it
  for (unsigned c = 0; c < file.mNumCameras; ++c) {
    camera_of.emplace(file.mCameras[c]->mName.C_Str(), file.mCameras[c]);
  }
  std::vector<std::pair<const aiNode*, aiMatrix4x4>> open = {{file.mRootNode, aiMatrix4x4()}};
  while (!open.empty()) {
    const auto [node, above] = open.back();
    open.pop_back();
    const aiMatrix4x4 place = above * node->mTransformation;
    for (unsigned k = 0; k < node->mNumMeshes; ++k) {
      const aiMesh& mesh = *file.mMeshes[node->mMeshes[k]];
      addMesh(mesh, objectName(*node, mesh), place);
    }
    const auto [first, last] = camera_of.equal_range(node->mName.C_Str());
    for (auto camera = first; camera != last; ++camera) addCamera(*camera->second, place);
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
  if (mesh.mColors[0] != nullptr) {
    notes_.add("colours of vertices do not change the reflectance, in", object, Severity::warning);
  }
  const bool mirrors = place.Determinant() < 0;
  const AssimpMaterial& material = materials_[mesh.mMaterialIndex];
  const Index surface = builder_.surface(object, material.index);
  const aiVector3D* const texcoords = mesh.mTextureCoords[material.set];
  std::vector<Index> corners;
  std::vector<Vec2> pairs;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices < 3) {
      notes_.add("lines and points have no area and are left out, in", object);
      continue;
    }
    corners.clear();
    pairs.clear();
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      const unsigned vertex = face.mIndices[mirrors ? face.mNumIndices - 1 - k : k];
      corners.push_back(Index(first + vertex));
      if (texcoords == nullptr) continue;
      // Assimp's origin is the bottom left corner.
      pairs.emplace_back(double(texcoords[vertex].x), 1 - double(texcoords[vertex].y));
      if (!std::isfinite(pairs.back().x) || !std::isfinite(pairs.back().y)) {
        fail(fmt::format("object {}: a texture coordinate is not a finite number; export it again",
                         object));
      }
    }
    builder_.addFace(corners, pairs, surface, f);
  }
}

/// Assimp's angle is horizontal, whole, whatever the file had.
void AssimpReader::addCamera(const aiCamera& given, const aiMatrix4x4& place) {
  // Assimp loses where they look at.
  if (lowerExtension(scene_.file) == ".3ds") {
    notes_.add("cameras of 3DS files are not used", given.mName.C_Str(), Severity::warning);
    return;
  }
  const auto vectorOf = [](const aiVector3D& v) {
    return Vec3(double(v.x), double(v.y), double(v.z));
  };
  const aiMatrix3x3 turn(place);
  const Vec3 forward = vectorOf(turn * given.mLookAt);
  Camera camera;
  camera.name = given.mName.C_Str();
  camera.eye = scale_ * vectorOf(place * given.mPosition);
  camera.up = vectorOf(turn * given.mUp);
  camera.aspect = std::max(0.0, double(given.mAspect));
  const double width = std::tan(0.5 * double(given.mHorizontalFOV));
  // Of a picture of which the file does not say how high it is: 4 : 3.
  camera.vertical_fov = 2 * std::atan(width / (camera.aspect > 0 ? camera.aspect : 4.0 / 3));
  const bool usable = isFinite(camera.eye) && isFinite(forward) &&
                      glm::length(glm::cross(forward, camera.up)) > 0 && camera.vertical_fov > 0 &&
                      camera.vertical_fov < std::numbers::pi;
  if (!usable) {
    notes_.add("cameras without a view direction or an angle are not used", camera.name,
               Severity::warning);
    return;
  }
  camera.target = camera.eye + glm::normalize(forward);
  camera.up = glm::normalize(camera.up);
  scene_.cameras.push_back(camera);
}

}  // namespace

namespace {

/// Assimp reads what is left of a 3DS file as if it were whole: its first chunk says how long it
/// is.
void requireWhole3ds(const std::string& path) {
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
  const std::string extension = lowerExtension(path);
  if (extension == ".3ds") requireWhole3ds(path);
  if (extension == ".dae" || extension == ".x3d") checkXml(path);
  return AssimpReader(path, options).read();
}

}  // namespace radiosity
