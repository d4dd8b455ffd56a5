// The targets of conditions: surfaces of a scene, or rows of a matrix.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/scene.h"

namespace radiosity {

class ConditionTargets {
 public:
  virtual ~ConditionTargets() = default;
  virtual std::size_t size() const = 0;
  /// The name of a target in messages.
  virtual std::string nameOf(Index target) const = 0;
  /// The name of each target, as groups join them; empty for one without.
  virtual std::vector<std::string> ownNames() const = 0;
  /// The kinds of things that have names: "surface, material or object with faces".
  virtual std::string_view kinds() const = 0;
  /// The targets that `name` stands for literally, ascending.
  virtual std::vector<Index> named(const std::string& name) const = 0;
  /// The targets with a name that matches `pattern`, ascending.
  virtual std::vector<Index> matching(const std::string& pattern) const = 0;
  virtual std::vector<std::string> knownNames() const = 0;
  /// The emissivity if no condition gives one.
  virtual std::optional<double> emissivityOf(Index target) const = 0;
  /// 1 - reflectance, if a condition asks for that. Errors: InputError naming the material, for a
  /// colour or a texture.
  virtual std::optional<double> emissivityOfMaterial(Index target) const = 0;
  /// The end of a message on missing emissivities.
  virtual std::string_view emissivityCure() const = 0;
};

/// Surfaces have three names: their own, their material's and their object's.
class SurfaceTargets : public ConditionTargets {
 public:
  explicit SurfaceTargets(const Scene& scene) : scene_(scene) {}
  std::size_t size() const override { return scene_.surfaces.size(); }
  std::string nameOf(Index target) const override { return scene_.surfaces[target].name; }
  std::vector<std::string> ownNames() const override;
  std::string_view kinds() const override { return "surface, material or object with faces"; }
  std::vector<Index> named(const std::string& name) const override;
  std::vector<Index> matching(const std::string& pattern) const override;
  std::vector<std::string> knownNames() const override;
  std::optional<double> emissivityOf(Index /*target*/) const override { return std::nullopt; }
  std::optional<double> emissivityOfMaterial(Index target) const override;
  std::string_view emissivityCure() const override {
    return "; the word material stands for 1 - reflectance";
  }

 private:
  const Scene& scene_;
};

/// Rows are named by their name or by their number from 1.
class RowTargets : public ConditionTargets {
 public:
  /// Keeps both by reference. `names`: N, empty for a row without one; `emissivity`: N, or empty.
  RowTargets(std::span<const std::string> names, std::span<const double> emissivity);
  std::size_t size() const override { return names_.size(); }
  std::string nameOf(Index target) const override;
  std::vector<std::string> ownNames() const override { return {names_.begin(), names_.end()}; }
  std::string_view kinds() const override { return "row"; }
  std::vector<Index> named(const std::string& name) const override;
  std::vector<Index> matching(const std::string& pattern) const override;
  std::vector<std::string> knownNames() const override;
  std::optional<double> emissivityOf(Index target) const override;
  std::optional<double> emissivityOfMaterial(Index target) const override {
    return emissivityOf(target);
  }
  std::string_view emissivityCure() const override { return ""; }

 private:
  std::span<const std::string> names_;
  std::span<const double> emissivity_;
  std::unordered_map<std::string, std::vector<Index>> by_name_;
};

}  // namespace radiosity
