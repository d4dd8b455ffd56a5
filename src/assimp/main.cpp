// radiosity-assimp PARENT: runs Assimp for the process that started it (scene/assimp/
// assimp_process.h), within limits of memory and time, since damaged files make Assimp crash or ask
// for all memory there is. Messages come and go by standard input.
#include <assimp/ColladaMetaData.h>
#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/metadata.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/assimp/assimp_messages.h"
#include "scene/assimp/assimp_scene.h"

namespace radiosity {

namespace {

constexpr int kSocket = STDIN_FILENO;

/// Memory and time grow with the bytes that are read: Assimp's models take up to some tens of bytes
/// a byte of the file, text and compressed numbers the most.
void allow(std::uint64_t bytes) {
  constexpr std::uint64_t kLeast = std::uint64_t(1) << 30, kPerByte = 100;
  constexpr std::uint64_t kLeastSeconds = 60, kBytesPerSecond = std::uint64_t(1) << 14;
  const rlimit memory{kLeast + kPerByte * bytes, RLIM_INFINITY};
  const rlimit seconds{kLeastSeconds + bytes / kBytesPerSecond, RLIM_INFINITY};
  setrlimit(RLIMIT_AS, &memory);
  setrlimit(RLIMIT_CPU, &seconds);
}

std::array<float, 3> tripleOf(const aiVector3D& v) { return {v.x, v.y, v.z}; }

std::string colladaId(const aiNode& node) {
  aiString id;
  const bool known = node.mMetaData != nullptr && node.mMetaData->Get(AI_METADATA_COLLADA_ID, id);
  return known ? id.C_Str() : "";
}

// We write out keys of materials, since AI_MATKEY macros expand to three arguments at once.
std::optional<std::array<float, 3>> colourOf(const aiMaterial& given, const char* key) {
  aiColor4D found;
  if (aiGetMaterialColor(&given, key, 0, 0, &found) != AI_SUCCESS) return std::nullopt;
  return std::array<float, 3>{found.r, found.g, found.b};
}

std::optional<AssimpTexture> textureOf(const aiScene& file, const aiMaterial& given) {
  aiString path;
  aiTextureMapping mapping = aiTextureMapping_UV;
  aiTextureMapMode modes[2] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
  AssimpTexture texture;
  if (aiGetMaterialTexture(&given, aiTextureType_DIFFUSE, 0, &path, &mapping, &texture.set,
                           &texture.blend, nullptr, modes, nullptr) != AI_SUCCESS) {
    return std::nullopt;
  }
  texture.path = path.C_Str();
  texture.by_coordinates = std::uint8_t(mapping == aiTextureMapping_UV);
  texture.wrap = {std::uint32_t(modes[0]), std::uint32_t(modes[1])};
  const int embedded = file.GetEmbeddedTextureAndIndex(path.C_Str()).second;
  if (embedded >= 0) texture.embedded = std::uint32_t(embedded);
  return texture;
}

AssimpFileMaterial materialOf(const aiScene& file, const aiMaterial& given) {
  AssimpFileMaterial material;
  aiString name;
  if (aiGetMaterialString(&given, AI_MATKEY_NAME, &name) == AI_SUCCESS) {
    material.name = name.C_Str();
  }
  material.diffuse = colourOf(given, "$clr.diffuse");
  material.emissive = colourOf(given, "$clr.emissive");
  int two_sided = 0;
  if (aiGetMaterialIntegerArray(&given, AI_MATKEY_TWOSIDED, &two_sided, nullptr) == AI_SUCCESS) {
    material.two_sided = two_sided;
  }
  float opacity = 1;
  if (aiGetMaterialFloatArray(&given, AI_MATKEY_OPACITY, &opacity, nullptr) == AI_SUCCESS) {
    material.opacity = opacity;
  }
  material.diffuse_textures = aiGetMaterialTextureCount(&given, aiTextureType_DIFFUSE);
  material.emissive_textures = aiGetMaterialTextureCount(&given, aiTextureType_EMISSIVE);
  material.opacity_textures = aiGetMaterialTextureCount(&given, aiTextureType_OPACITY);
  material.normal_textures = aiGetMaterialTextureCount(&given, aiTextureType_NORMALS);
  material.height_textures = aiGetMaterialTextureCount(&given, aiTextureType_HEIGHT);
  if (material.diffuse_textures > 0) material.texture = textureOf(file, given);
  return material;
}

AssimpMesh meshOf(const aiMesh& given, const std::vector<AssimpFileMaterial>& materials) {
  AssimpMesh mesh;
  mesh.name = given.mName.C_Str();
  mesh.material = given.mMaterialIndex;
  std::uint32_t set = 0;
  if (mesh.material < materials.size()) {
    const std::optional<AssimpTexture>& texture = materials[mesh.material].texture;
    if (texture) set = texture->set;
  }
  const aiVector3D* const coordinates =
      set < AI_MAX_NUMBER_OF_TEXTURECOORDS ? given.mTextureCoords[set] : nullptr;
  for (unsigned v = 0; v < given.mNumVertices; ++v) {
    mesh.vertices.push_back(tripleOf(given.mVertices[v]));
    if (const aiColor4D* const colours = given.mColors[0]) {
      mesh.colours.push_back({colours[v].r, colours[v].g, colours[v].b});
    }
    if (coordinates != nullptr) mesh.texcoords.push_back({coordinates[v].x, coordinates[v].y});
  }
  for (unsigned f = 0; f < given.mNumFaces; ++f) {
    const aiFace& face = given.mFaces[f];
    mesh.corners.push_back(face.mNumIndices);
    mesh.indices.insert(mesh.indices.end(), face.mIndices, face.mIndices + face.mNumIndices);
  }
  return mesh;
}

/// Parents before children, in the file's order. (There is no recursion, since chains may have any
/// length.)
std::vector<AssimpNode> nodesOf(const aiNode* root) {
  std::vector<AssimpNode> nodes;
  std::vector<std::pair<const aiNode*, std::uint32_t>> open = {{root, 0}};
  while (!open.empty()) {
    const auto [given, parent] = open.back();
    open.pop_back();
    AssimpNode node{parent, given->mName.C_Str(), colladaId(*given), {}, {}};
    for (unsigned k = 0; k < node.place.size(); ++k) {
      node.place[k] = given->mTransformation[k / 4][k % 4];
    }
    node.meshes.assign(given->mMeshes, given->mMeshes + given->mNumMeshes);
    const auto self = std::uint32_t(nodes.size());
    nodes.push_back(std::move(node));
    for (unsigned k = given->mNumChildren; k-- > 0;) open.emplace_back(given->mChildren[k], self);
  }
  return nodes;
}

/// The unit of FBX; Collada's is in its root node.
std::optional<double> centimetresOf(const aiScene& file) {
  double centimetres = 0;
  float single = 0;
  if (file.mMetaData == nullptr) return std::nullopt;
  if (file.mMetaData->Get("UnitScaleFactor", centimetres)) return centimetres;
  if (file.mMetaData->Get("UnitScaleFactor", single)) return double(single);
  return std::nullopt;
}

AssimpScene sceneOf(const aiScene& file) {
  AssimpScene scene;
  scene.nodes = nodesOf(file.mRootNode);
  for (unsigned m = 0; m < file.mNumMaterials; ++m) {
    scene.materials.push_back(materialOf(file, *file.mMaterials[m]));
  }
  for (unsigned m = 0; m < file.mNumMeshes; ++m) {
    scene.meshes.push_back(meshOf(*file.mMeshes[m], scene.materials));
  }
  for (unsigned c = 0; c < file.mNumCameras; ++c) {
    const aiCamera& camera = *file.mCameras[c];
    scene.cameras.push_back({camera.mName.C_Str(), camera.mAspect, camera.mHorizontalFOV,
                             tripleOf(camera.mPosition), tripleOf(camera.mUp),
                             tripleOf(camera.mLookAt)});
  }
  for (unsigned t = 0; t < file.mNumTextures; ++t) {
    const aiTexture& texture = *file.mTextures[t];
    AssimpImage image;
    image.is_bare = std::uint8_t(texture.mHeight != 0);
    if (image.is_bare == 0) {  // compressed, of mWidth bytes
      image.bytes.assign(reinterpret_cast<const char*>(texture.pcData), texture.mWidth);
    }
    scene.images.push_back(std::move(image));
  }
  for (unsigned l = 0; l < file.mNumLights; ++l) {
    const aiLight& light = *file.mLights[l];
    const aiColor3D& colour = light.mColorDiffuse;
    scene.lights.push_back({light.mName.C_Str(),
                            std::uint32_t(light.mType),
                            tripleOf(light.mPosition),
                            tripleOf(light.mDirection),
                            {colour.r, colour.g, colour.b},
                            light.mAngleInnerCone,
                            light.mAngleOuterCone});
  }
  scene.centimetres = centimetresOf(file);
  return scene;
}

using File = std::unique_ptr<const aiScene, void (*)(const aiScene*)>;

/// A 3DS file whose animation leaves a light out gives it no node, without which Assimp refuses the
/// whole scene. Its place is that of the light itself.
void addNodesOfLights(const aiScene& file) {
  for (unsigned l = 0; l < file.mNumLights; ++l) {
    const aiString& name = file.mLights[l]->mName;
    if (file.mRootNode->FindNode(name) != nullptr) continue;
    aiNode* node = std::make_unique<aiNode>(name.C_Str()).release();  // the scene's from here on
    file.mRootNode->addChildren(1, &node);
  }
}

File import(const std::string& path) {
  const std::unique_ptr<aiPropertyStore, void (*)(aiPropertyStore*)> wishes(aiCreatePropertyStore(),
                                                                            aiReleasePropertyStore);
  // We want the names that people gave, not ids.
  aiSetImportPropertyInteger(wishes.get(), AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, 1);
  // Assimp must not add octahedra for nodes if a file has no meshes.
  aiSetImportPropertyInteger(wishes.get(), AI_CONFIG_IMPORT_NO_SKELETON_MESHES, 1);
  File file{aiImportFileExWithProperties(path.c_str(), 0, nullptr, wishes.get()), aiReleaseImport};
  if (file == nullptr || file->mRootNode == nullptr) return file;
  addNodesOfLights(*file);
  constexpr unsigned kSteps = aiProcess_ValidateDataStructure | aiProcess_TransformUVCoords;
  if (aiApplyPostProcessing(file.get(), kSteps) == nullptr) static_cast<void>(file.release());
  return file;
}

void answer(const std::string& path) {
  allow(std::filesystem::file_size(path));
  const File file = import(path);
  if (file == nullptr || file->mRootNode == nullptr) {
    sendMessage(kSocket, AssimpMessage::cannot_read, aiGetErrorString());
    return;
  }
  AssimpWriter writer;
  const AssimpScene scene = sceneOf(*file);
  passScene(writer, scene);
  sendMessage(kSocket, AssimpMessage::scene, writer.bytes);
}

}  // namespace

}  // namespace radiosity

int main(int count, char** words) {
  using namespace radiosity;
  // Ends with the parent, which may have ended before this line.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (count != 2 || std::to_string(getppid()) != words[1]) return EXIT_FAILURE;
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  std::set_new_handler([] { std::_Exit(kAssimpOutOfMemory); });
  allow(0);
  std::string path;
  const auto request = receiveMessage(kSocket, path, ~std::uint64_t(0));
  if (request != AssimpMessage::read) return EXIT_FAILURE;
  answer(path);
  std::_Exit(EXIT_SUCCESS);  // the memory of a large scene need not be taken apart
}
