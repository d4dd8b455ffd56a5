// Reads Collada, FBX, 3DS, X3D, VRML, IFC, AC3D, LightWave, DXF, MilkShape and Blitz3D by Assimp.
// Nodes are objects.
#include <assimp/ColladaMetaData.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <glm/geometric.hpp>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <sstream>
#include <string_view>

#include "base/file_name.h"
#include "base/finite.h"
#include "base/input_file.h"
#include "scene/assimp/ac3d_document.h"
#include "scene/assimp/assimp_files.h"
#include "scene/assimp/assimp_library.h"
#include "scene/assimp/assimp_materials.h"
#include "scene/assimp/collada_cameras.h"
#include "scene/assimp/nesting_preflight.h"
#include "scene/assimp/vrml_document.h"
#include "scene/assimp/x3d_document.h"
#include "scene/assimp/xml_preflight.h"
#include "scene/mesh_cursor.h"
#include "scene/readers.h"
#include "scene/scene_builder.h"
#include "scene/text.h"

namespace radiosity {

namespace {

class AssimpReader {
 public:
  AssimpReader(const std::string& path, const SceneOptions& options)
      : options_(options), builder_(scene_, options) {
    scene_.file = path;
  }

  Scene read() {
    const std::string extension = lowerExtension(scene_.file);
    if (extension == ".dae") collada_.emplace(checkXml(scene_.file), notes_);
    const bool is_vrml = extension == ".wrl";
    const bool is_ac3d = extension.starts_with(".ac");
    AssimpFiles rewritten([this, is_ac3d](const std::string& path) {
      return is_ac3d ? rewrittenAc3d(path) : rewrittenX3d(path);
    });
    const File file = is_vrml ? import(scene_.file + ".x3d", rewritten.io())
                      : is_ac3d || extension == ".x3d" ? import(scene_.file, rewritten.io())
                                                       : import(scene_.file, nullptr);
    if (file == nullptr || file->mRootNode == nullptr) {
      rewritten.rethrow();
      const std::string why = library_.getErrorString();
      if (why.find("mNumMeshes is 0") != std::string::npos) failWithoutFaces();
      fail(fmt::format("cannot be read ({}); export it again, or as .obj or .glb", onOneLine(why)));
    }
    materials_ = readAssimpMaterials(*file, x3dMaterials(*file), options_, scene_, notes_);
    scale_ = x3d_.metres_per_unit * metresPerUnit(*file);
    addNodes(*file);
    for (Camera viewpoint : x3d_.viewpoints) {
      const Vec3 forward = viewpoint.target - viewpoint.eye;
      viewpoint.eye *= scale_;
      addCamera(viewpoint, forward);
    }
    if (scene_.faceCount() == 0) failWithoutFaces();
    if (file->mNumLights > 0) {
      scene_.notes.push_back({Severity::warning,
                              "lights without a surface are left out; make a "
                              "surface a lamp by --set NAME.radiance=10"});
    }
    notes_.appendTo(scene_.notes);
    builder_.finish();
    // In all of these formats a texture replaces the colour.
    for (Material& material : scene_.materials) {
      if (material.texture != kNone) material.reflectance = Vec3(1.0);
    }
    return std::move(scene_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", scene_.file, what));
  }

  [[noreturn]] void failWithoutFaces() const {
    std::vector<Note> left_out;  // of other formats the notes are about parts that are read
    const std::string extension = lowerExtension(scene_.file);
    if (extension == ".x3d" || extension == ".wrl") notes_.appendTo(left_out);
    fail(fmt::format("no faces{}; export the scene with its meshes as polygons",
                     left_out.empty() ? "" : " (" + left_out.front().text + ")"));
  }

  using File = std::unique_ptr<const aiScene, void (*)(const aiScene*)>;

  File import(const std::string& path, aiFileIO* files) const;
  std::string rewrittenX3d(const std::string& path);
  std::string rewrittenAc3d(const std::string& path);
  const X3dShape* x3dShape(const aiNode& node) const;
  std::map<unsigned, std::string> x3dMaterials(const aiScene& file) const;
  std::string objectName(const aiNode& node, const aiMesh& mesh) const;
  static double metresPerUnit(const aiScene& file);
  void addNodes(const aiScene& file);
  std::vector<Vec3> coloursOf(const aiMesh& mesh, const std::string& object);
  void addMesh(const aiMesh& mesh, const aiNode& node, const aiMatrix4x4& place);
  Index twoSided(Index material);
  Index colouredByVertices(Index material);
  Index variant(std::map<Index, Index>& known, Index material, const char* mark,
                const std::function<void(Material&)>& change);
  void addCameras(const aiNode& node, const aiMatrix4x4& place);
  void addCamera(Camera camera, const Vec3& forward);

  const SceneOptions& options_;
  const AssimpLibrary& library_ = assimpLibrary();
  Scene scene_;
  SceneBuilder builder_;
  std::vector<AssimpMaterial> materials_;  ///< by number in the file
  FeatureNotes notes_;
  double scale_ = 1;
  std::multimap<std::string, const aiCamera*> camera_of_;  ///< by its node
  std::optional<ColladaCameras> collada_;                  ///< replaces camera_of_
  X3dExtras x3d_;
  std::vector<X3dShape> x3d_shapes_;
  std::map<Index, Index> two_sided_;  ///< by material: the same for both sides
  std::map<Index, Index> coloured_;   ///< by material: the same for colours of vertices
};

AssimpReader::File AssimpReader::import(const std::string& path, aiFileIO* files) const {
  const std::unique_ptr<aiPropertyStore, void (*)(aiPropertyStore*)> wishes(
      library_.createPropertyStore(), library_.releasePropertyStore);
  // We want the names that people gave, not ids.
  library_.setImportPropertyInteger(wishes.get(), AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, 1);
  // Assimp must not add octahedra for nodes if a file has no meshes.
  library_.setImportPropertyInteger(wishes.get(), AI_CONFIG_IMPORT_NO_SKELETON_MESHES, 1);
  // Of AC3D, a mesh all of whose strips are slivers without an area has no vertices, at which the
  // check of the whole file fails.
  const bool is_ac3d = lowerExtension(path).starts_with(".ac");
  const unsigned check = is_ac3d ? 0U : unsigned(aiProcess_ValidateDataStructure);
  return {library_.importFileExWithProperties(path.c_str(), check | aiProcess_TransformUVCoords,
                                              files, wishes.get()),
          library_.releaseImport};
}

/// The rewritten X3D, or VRML as X3D. Of a file inside another (Inline) only the shapes count.
std::string AssimpReader::rewrittenX3d(const std::string& path) {
  if (lowerExtension(path) != ".x3d") return readWholeFile(path);
  const std::string vrml = path.substr(0, path.size() - std::string_view(".x3d").size());
  const bool is_vrml = lowerExtension(vrml) == ".wrl";
  pugi::xml_document document = is_vrml ? readVrml(vrml, notes_) : checkXml(path);
  if (document.empty()) return readWholeFile(path);
  if (is_vrml) checkXml(vrml, document);
  X3dExtras extras = rewriteX3d(document, x3d_shapes_, notes_);
  if ((is_vrml ? vrml : path) == scene_.file) x3d_ = std::move(extras);
  std::ostringstream out;
  document.save(out, "", pugi::format_raw);
  return out.str();
}

std::string AssimpReader::rewrittenAc3d(const std::string& path) {
  const std::string content = readWholeFile(path);
  checkAc3dNesting(path, content);
  if (const std::size_t faces = twoSidedFacesOfAc3d(content); faces > 0) {
    scene_.notes.push_back(
        {Severity::info, fmt::format("faces that are two-sided in the file are read one-sided "
                                     "({}); use --two-sided NAME where backs are seen",
                                     faces)});
  }
  return rewriteAc3d(content, notes_);
}

/// Calls visit(node, place) for all nodes, each before its children. (There is no recursion, since
/// chains may have any length.)
template <class Visit>
void forNodes(const aiScene& file, const Visit& visit) {
  std::vector<std::pair<const aiNode*, aiMatrix4x4>> open = {{file.mRootNode, aiMatrix4x4()}};
  while (!open.empty()) {
    const auto [node, above] = open.back();
    open.pop_back();
    const aiMatrix4x4 place = above * node->mTransformation;
    visit(*node, place);
    for (unsigned k = node->mNumChildren; k-- > 0;) open.emplace_back(node->mChildren[k], place);
  }
}

/// Whether Assimp invented the name.
bool isMadeUp(std::string_view name) {
  return name.empty() || name[0] == '<' || name.starts_with("$ColladaAutoName$");
}

std::string colladaId(const aiNode& node) {
  aiString id;
  const bool known = node.mMetaData != nullptr && node.mMetaData->Get(AI_METADATA_COLLADA_ID, id);
  return known ? id.C_Str() : "";
}

/// The shape of X3D in a node, or null.
const X3dShape* AssimpReader::x3dShape(const aiNode& node) const {
  const std::optional<std::size_t> number = x3dShapeNumber(node.mName.C_Str());
  return number && *number < x3d_shapes_.size() ? &x3d_shapes_[*number] : nullptr;
}

/// Names of the materials of X3D's meshes, by their numbers; nothing for other formats.
std::map<unsigned, std::string> AssimpReader::x3dMaterials(const aiScene& file) const {
  std::map<unsigned, std::string> names;
  if (x3d_shapes_.empty()) return names;
  forNodes(file, [&](const aiNode& node, const aiMatrix4x4&) {
    const X3dShape* const shape = x3dShape(node);
    for (unsigned k = 0; k < node.mNumMeshes; ++k) {
      names[file.mMeshes[node.mMeshes[k]]->mMaterialIndex] =
          shape == nullptr ? "" : shape->material;
    }
  });
  return names;
}

/// The name of an object. If an IFC file has an object in several places, such as a window, Assimp
/// names it after the kind of reference; then the node above has the name.
std::string AssimpReader::objectName(const aiNode& node, const aiMesh& mesh) const {
  std::string of_file = std::filesystem::path(scene_.file).stem().string();
  if (const X3dShape* const shape = x3dShape(node)) {
    return shape->name.empty() ? of_file : shape->name;
  }
  constexpr std::string_view kReference = "IfcMappedItem";
  const aiNode* named = &node;
  while (named->mParent != nullptr && named->mName.C_Str() == kReference) named = named->mParent;
  for (std::string name :
       {std::string(named->mName.C_Str()), colladaId(*named), std::string(mesh.mName.C_Str())}) {
    if (!isMadeUp(name)) return name;
  }
  return of_file;
}

/// The unit of a file in metres. FBX gives it in centimetres; Collada's is in its root node.
double AssimpReader::metresPerUnit(const aiScene& file) {
  double centimetres = 0;
  float single = 0;
  if (file.mMetaData == nullptr) return 1;
  if (file.mMetaData->Get("UnitScaleFactor", centimetres)) return centimetres / 100;
  if (file.mMetaData->Get("UnitScaleFactor", single)) return double(single) / 100;
  return 1;
}

void AssimpReader::addNodes(const aiScene& file) {
  for (unsigned c = 0; c < file.mNumCameras; ++c) {
    camera_of_.emplace(file.mCameras[c]->mName.C_Str(), file.mCameras[c]);
  }
  forNodes(file, [&](const aiNode& node, const aiMatrix4x4& place) {
    for (unsigned k = 0; k < node.mNumMeshes; ++k) {
      addMesh(*file.mMeshes[node.mMeshes[k]], node, place);
    }
    addCameras(node, place);
  });
}

Index AssimpReader::twoSided(Index material) {
  if (scene_.materials[material].two_sided) return material;
  const auto turn = [](Material& both) { both.two_sided = true; };
  return variant(two_sided_, material, " (two-sided)", turn);
}

/// The same for a material without a colour: those of vertices are the reflectance.
Index AssimpReader::colouredByVertices(Index material) {
  const auto whiten = [](Material& coloured) { coloured.reflectance = Vec3(1.0); };
  return variant(coloured_, material, " (vertex colours)", whiten);
}

/// A changed copy of a material, made once; `known`: those made so far.
Index AssimpReader::variant(std::map<Index, Index>& known, Index material, const char* mark,
                            const std::function<void(Material&)>& change) {
  const auto [place, is_new] = known.emplace(material, Index(scene_.materials.size()));
  if (is_new) {
    Material copy = scene_.materials[material];
    copy.name += mark;
    change(copy);
    scene_.materials.push_back(std::move(copy));
  }
  return place->second;
}

/// Factors of the reflectance, one a vertex; empty if there are none, or if they are not used.
std::vector<Vec3> AssimpReader::coloursOf(const aiMesh& mesh, const std::string& object) {
  const aiColor4D* const given = mesh.mColors[0];
  if (given == nullptr) return {};
  if (options_.vertex_colours == VertexColours::unused) {
    notes_.add(
        "colours of vertices do not change the reflectance (--vertex-colours srgb or linear uses "
        "them), in",
        object, Severity::warning);
    return {};
  }
  std::vector<Vec3> factors;
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const Vec3 colour(double(given[v].r), double(given[v].g), double(given[v].b));
    const std::optional<Vec3> factor = factorOfColour(colour, options_.vertex_colours);
    if (!factor) {
      fail(
          fmt::format("object {}: a colour of vertex {} is outside 0 to 1; scale it, or leave out "
                      "--vertex-colours",
                      object, v));
    }
    factors.push_back(*factor);
  }
  return factors;
}

void AssimpReader::addMesh(const aiMesh& mesh, const aiNode& node, const aiMatrix4x4& place) {
  const std::string object = objectName(node, mesh);
  if (mesh.mNumVertices == 0) return notes_.add("shapes without corners are left out", object);
  const std::size_t first = scene_.vertices.size();
  if (first + mesh.mNumVertices >= kNone) fail("too many vertices; split the scene");
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiVector3D p = place * mesh.mVertices[v];
    scene_.vertices.push_back(scale_ * Vec3(double(p.x), double(p.y), double(p.z)));
    if (!isFinite(scene_.vertices.back())) {
      fail(fmt::format("object {}: a coordinate is not a finite number; export it again", object));
    }
  }
  const std::vector<Vec3> colours = coloursOf(mesh, object);
  const X3dShape* const shape = x3dShape(node);
  const bool mirrors = place.Determinant() < 0;
  const bool clockwise = shape != nullptr && shape->clockwise;
  Index material = materials_[mesh.mMaterialIndex].index;
  if (!colours.empty() && !materials_[mesh.mMaterialIndex].has_colour) {
    material = colouredByVertices(material);
  }
  if (shape != nullptr && shape->two_sided) material = twoSided(material);
  const Index surface = builder_.surface(object, material);
  const aiVector3D* const texcoords = mesh.mTextureCoords[materials_[mesh.mMaterialIndex].set];
  std::vector<Index> corners;
  std::vector<Vec2> pairs;
  std::vector<Vec3> factors;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices < 3) {
      notes_.add("lines and points have no area and are left out, in", object);
      continue;
    }
    corners.clear();
    pairs.clear();
    factors.clear();
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      const unsigned vertex = face.mIndices[mirrors != clockwise ? face.mNumIndices - 1 - k : k];
      corners.push_back(Index(first + vertex));
      if (!colours.empty()) factors.push_back(colours[vertex]);
      if (texcoords == nullptr) continue;
      // Assimp's origin is the bottom left corner.
      pairs.emplace_back(double(texcoords[vertex].x), 1 - double(texcoords[vertex].y));
      if (!std::isfinite(pairs.back().x) || !std::isfinite(pairs.back().y)) {
        fail(fmt::format("object {}: a texture coordinate is not a finite number; export it again",
                         object));
      }
    }
    builder_.addFace(corners, pairs, surface, f, factors);
  }
}

/// Adds the cameras of a node. Assimp's angle is the full horizontal one for all formats.
void AssimpReader::addCameras(const aiNode& node, const aiMatrix4x4& place) {
  const auto vectorOf = [](const aiVector3D& v) {
    return Vec3(double(v.x), double(v.y), double(v.z));
  };
  const aiMatrix3x3 turn(place);
  const auto add = [&](Camera camera, const aiCamera& pose) {
    const std::string id = colladaId(node);
    camera.name = isMadeUp(node.mName.C_Str()) && !id.empty() ? id : node.mName.C_Str();
    camera.eye = scale_ * vectorOf(place * pose.mPosition);
    camera.up = vectorOf(turn * pose.mUp);
    addCamera(std::move(camera), vectorOf(turn * pose.mLookAt));
  };
  if (collada_) {
    aiCamera pose;
    pose.mLookAt = {0, 0, -1};
    for (const Camera& c : collada_->of(colladaId(node), node.mName.C_Str())) add(c, pose);
    return;
  }
  const auto [first, last] = camera_of_.equal_range(node.mName.C_Str());
  for (auto it = first; it != last; ++it) {
    const aiCamera& given = *it->second;
    // Assimp loses their targets.
    if (lowerExtension(scene_.file) == ".3ds") {
      notes_.add("cameras of 3DS files are not used", given.mName.C_Str(), Severity::warning);
      continue;
    }
    Camera camera;
    camera.aspect = std::max(0.0, double(given.mAspect));
    const double width = std::tan(0.5 * double(given.mHorizontalFOV));
    // If the file does not give the height of the picture, we take 4 : 3.
    camera.vertical_fov = 2 * std::atan(width / (camera.aspect > 0 ? camera.aspect : 4.0 / 3));
    add(std::move(camera), given);
  }
}

/// `camera` has everything but a target.
void AssimpReader::addCamera(Camera camera, const Vec3& forward) {
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
  scene_.cameras.push_back(std::move(camera));
}

}  // namespace

namespace {

/// Refuses a truncated 3DS file, which Assimp reads as if it were complete. The first chunk has the
/// length.
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
  if (extension == ".fbx") checkFbxNesting(path, readWholeFile(path));
  if (extension == ".b3d") checkBlitz3dNesting(path, readWholeFile(path));
  return AssimpReader(path, options).read();
}

}  // namespace radiosity
