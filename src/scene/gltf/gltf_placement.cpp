#include "scene/gltf/gltf_placement.h"

#include <algorithm>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "base/finite.h"
#include "scene/gltf/gltf_nodes.h"

namespace radiosity {

GltfPlacement::GltfPlacement(const GltfFile& file)
    : file_(file), world_(file.model.nodes.size(), glm::dmat4(1.0)) {
  forEachGltfNode(file, [this](int node, const glm::dmat4& transform, const std::string&) {
    world_[std::size_t(node)] = transform;
  });
}

std::vector<glm::dmat4> GltfPlacement::copies(int number, const std::string& what) const {
  const glm::dmat4& own = world_[std::size_t(number)];
  if (!file_.model.nodes[std::size_t(number)].extensions.contains(kGltfInstancing)) return {own};
  std::vector<glm::dmat4> result = copiesInNode(number, what);
  for (glm::dmat4& copy : result) copy = own * copy;
  return result;
}

std::vector<glm::dmat4> GltfPlacement::copiesInNode(int number, const std::string& what) const {
  const tinygltf::Node& node = file_.model.nodes[std::size_t(number)];
  const auto extension = node.extensions.find(kGltfInstancing);
  if (extension == node.extensions.end()) return {};
  const tinygltf::Value& attributes = memberOf(extension->second, "attributes");
  std::size_t count = 0;
  const auto read = [&](const char* name, int components) -> std::vector<double> {
    if (!attributes.Has(name)) return {};
    const std::string attribute = fmt::format("{}: {} of its copies", what, name);
    std::vector<double> values =
        file_.readNumbers(attributes.Get(name).GetNumberAsInt(), components, attribute);
    const std::size_t elements = values.size() / std::size_t(components);
    if (count != 0 && elements != count) {
      file_.fail(fmt::format("{} has {} elements, others have {}; export the scene again",
                             attribute, elements, count));
    }
    count = elements;
    return values;
  };
  const std::vector<double> move = read("TRANSLATION", 3);
  const std::vector<double> turn = read("ROTATION", 4);
  const std::vector<double> scale = read("SCALE", 3);
  std::vector<glm::dmat4> result;
  result.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    result.push_back(gltfTransform(file_, move.empty() ? nullptr : &move[3 * k],
                                   turn.empty() ? nullptr : &turn[4 * k],
                                   scale.empty() ? nullptr : &scale[3 * k], what));
  }
  return result;
}

std::vector<Vec3> GltfPlacement::positions(int node, const tinygltf::Primitive& primitive,
                                           const glm::dmat4& copy, const std::string& what) const {
  std::vector<double> numbers =
      file_.readNumbers(primitive.attributes.at("POSITION"), 3, what + ": POSITION");
  addMorphTargets(node, primitive, numbers, what);
  std::vector<Vec3> positions;
  positions.reserve(numbers.size() / 3);
  const bool skinned = isSkinned(node) && primitive.attributes.contains("JOINTS_0");
  for (std::size_t k = 0; k < numbers.size(); k += 3) {
    const glm::dvec4 local(numbers[k], numbers[k + 1], numbers[k + 2], 1.0);
    positions.emplace_back(skinned ? local : copy * local);
  }
  if (skinned) bend(node, primitive, positions, what);
  for (std::size_t k = 0; k < positions.size(); ++k) {
    if (isFinite(positions[k])) continue;
    file_.fail(
        fmt::format("{}: vertex {} is not finite; correct the mesh or its transform", what, k));
  }
  return positions;
}

bool GltfPlacement::isMirrored(int node, const glm::dmat4& copy) const {
  // Joints that mirror do so all together: a skin that is half turned over would be torn.
  const glm::dmat4 whole = isSkinned(node) ? jointTransforms(node, "node").front() : copy;
  return glm::determinant(glm::dmat3(whole)) < 0;
}

bool GltfPlacement::isSkinned(int node) const {
  return file_.model.nodes[std::size_t(node)].skin >= 0;
}

/// The matrix that takes a vertex from the mesh to its place at each joint of the skin.
std::vector<glm::dmat4> GltfPlacement::jointTransforms(int node, const std::string& what) const {
  const tinygltf::Skin& skin =
      file_.at(file_.model.skins, file_.model.nodes[std::size_t(node)].skin, "skin", what);
  if (skin.joints.empty()) file_.fail(what + ": its skin has no joints; export the scene again");
  std::vector<double> inverse;
  if (skin.inverseBindMatrices >= 0) {
    inverse = file_.readNumbers(skin.inverseBindMatrices, 16, what + ": inverseBindMatrices");
    if (inverse.size() < 16 * skin.joints.size()) {
      file_.fail(what +
                 ": its skin has fewer inverse bind matrices than joints; export the scene "
                 "again");
    }
  }
  std::vector<glm::dmat4> result;
  for (std::size_t j = 0; j < skin.joints.size(); ++j) {
    file_.at(file_.model.nodes, skin.joints[j], "node", what + ": its skin");
    glm::dmat4 from_mesh(1.0);
    for (int k = 0; k < 16 && !inverse.empty(); ++k) {
      from_mesh[k / 4][k % 4] = inverse[16 * j + std::size_t(k)];
    }
    result.push_back(world_[std::size_t(skin.joints[j])] * from_mesh);
  }
  return result;
}

void GltfPlacement::addMorphTargets(int node, const tinygltf::Primitive& primitive,
                                    std::vector<double>& numbers, const std::string& what) const {
  const tinygltf::Node& owner = file_.model.nodes[std::size_t(node)];
  const std::vector<double>& weights =
      owner.weights.empty() ? file_.model.meshes[std::size_t(owner.mesh)].weights : owner.weights;
  for (std::size_t t = 0; t < std::min(weights.size(), primitive.targets.size()); ++t) {
    const auto moves = primitive.targets[t].find("POSITION");
    if (weights[t] == 0 || moves == primitive.targets[t].end()) continue;
    const std::string target = fmt::format("{}: morph target {}", what, t);
    const std::vector<double> by = file_.readNumbers(moves->second, 3, target);
    if (by.size() != numbers.size()) {
      file_.fail(fmt::format("{} has {} elements for {} vertices; export the scene again", target,
                             by.size() / 3, numbers.size() / 3));
    }
    for (std::size_t k = 0; k < by.size(); ++k) numbers[k] += weights[t] * by[k];
  }
}

/// Linear blend skinning: a vertex goes to the mean of where its joints have it, by their weights.
void GltfPlacement::bend(int node, const tinygltf::Primitive& primitive,
                         std::vector<Vec3>& positions, const std::string& what) const {
  const std::vector<glm::dmat4> joints = jointTransforms(node, what);
  std::vector<glm::dvec4> bent(positions.size(), glm::dvec4(0.0));
  std::vector<double> total(positions.size(), 0.0);
  for (int set = 0; primitive.attributes.contains(fmt::format("JOINTS_{}", set)); ++set) {
    const auto read = [&](const char* kind) {
      const std::string name = fmt::format("{}_{}", kind, set);
      const auto accessor = primitive.attributes.find(name);
      if (accessor == primitive.attributes.end())
        file_.fail(fmt::format("{}: has no {}", what, name));
      std::vector<double> values =
          file_.readNumbers(accessor->second, 4, fmt::format("{}: {}", what, name));
      if (values.size() == 4 * positions.size()) return values;
      file_.fail(fmt::format("{}: {} has {} elements for {} vertices; export the scene again", what,
                             name, values.size() / 4, positions.size()));
    };
    const std::vector<double> joint = read("JOINTS");
    const std::vector<double> weight = read("WEIGHTS");
    for (std::size_t k = 0; k < joint.size(); ++k) {
      if (weight[k] == 0) continue;
      if (joint[k] < 0 || std::size_t(joint[k]) >= joints.size()) {
        file_.fail(fmt::format("{}: joint {} does not exist, there are {}; export the scene again",
                               what, joint[k], joints.size()));
      }
      bent[k / 4] +=
          weight[k] * (joints[std::size_t(joint[k])] * glm::dvec4(positions[k / 4], 1.0));
      total[k / 4] += weight[k];
    }
  }
  for (std::size_t k = 0; k < positions.size(); ++k) {
    // Weights are rounded in the file. A vertex without any goes with the first joint.
    positions[k] =
        Vec3(total[k] > 0 ? bent[k] / total[k] : joints.front() * glm::dvec4(positions[k], 1.0));
  }
}

}  // namespace radiosity
