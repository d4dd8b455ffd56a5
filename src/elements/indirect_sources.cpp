#include "elements/indirect_sources.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/parallel.h"

namespace radiosity {
namespace {

/// The series of changes is not summed if each is more than this share of the one before.
constexpr double kMostLeft = 0.9;

}  // namespace

/// In a triangle, points beyond its longest side are mirrored into it.
std::vector<double> patchMeans(const PatchMesh& mesh, const ElementRoots& roots,
                               const ElementLookup& lookup, const ElementField& field,
                               std::size_t bands) {
  std::vector<double> means(mesh.size() * bands, 0.0);
  constexpr int kSide = 8;
  parallelFor(mesh.size(), 64, [&](std::size_t i) {
    double whole = 0;
    std::vector<double> sum(bands, 0.0);
    for (std::size_t r = roots.of_patch[i]; r < roots.of_patch[i + 1]; ++r) {
      const bool quad = roots.cornerCount(r) == 4;
      const auto& c = roots.corner[r];
      const Vec3 a = mesh.vertices[c[0]];
      const Vec3 ab = mesh.vertices[c[1]] - a;
      const Vec3 ad = mesh.vertices[c[quad ? 3 : 2]] - a;
      const Vec3 fold = quad ? mesh.vertices[c[2]] - a - ab - ad : Vec3(0.0);
      std::vector<double> light(bands);
      for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
          Vec2 at{(x + 0.5) / kSide, (y + 0.5) / kSide};
          const double weight = glm::length(glm::cross(ab + at.y * fold, ad + at.x * fold));
          if (!quad && at.x + at.y > 1) at = Vec2(1.0) - at;
          std::fill(light.begin(), light.end(), 0.0);
          lookup.add(field, r, at, light);
          whole += weight * (quad ? 1 : 0.5);
          for (std::size_t b = 0; b < bands; ++b) {
            sum[b] += weight * (quad ? 1 : 0.5) * light[b];
          }
        }
      }
    }
    for (std::size_t b = 0; b < bands && whole > 0; ++b) means[i * bands + b] = sum[b] / whole;
  });
  return means;
}

IndirectSources::IndirectSources(const PatchMesh& mesh, const PatchMaterials& materials,
                                 const ElementSurface& surface, const ElementLookup& lookup,
                                 std::span<const double> solved)
    : mesh_(mesh),
      materials_(materials),
      surface_(surface),
      lookup_(lookup),
      bands_(std::size_t(materials.bands)),
      solved_(solved),
      light_(solved.begin(), solved.end()),
      added_(solved.size(), 0.0) {
  field_.elements.resize(surface.roots.size());
}

bool IndirectSources::isEvaluated(std::size_t patch) const {
  const std::size_t root = surface_.roots.of_patch[patch];
  return root < surface_.roots.of_patch[patch + 1] && field_.elements[root].corners != 0;
}

void IndirectSources::take(ElementField field) {
  field_ = std::move(field);
  before_ = std::move(light_);
  light_ = patchMeans(mesh_, surface_.roots, lookup_, field_, bands_);
  for (std::size_t k = 0; k < light_.size(); ++k) {
    if (isEvaluated(k / bands_)) light_[k] += added_[k];
  }
  raiseOthers();
  std::vector<double> moved(light_.size());
  for (std::size_t k = 0; k < light_.size(); ++k) moved[k] = std::abs(light_[k] - before_[k]);
  moved_ = reflectedPower(moved);
  gained_before_ = gained_;
  gained_ = reflectedPower(light_) - reflectedPower(before_);
}

/// Gives patches that are not evaluated the light of the solution, times what the others have over
/// theirs.
void IndirectSources::raiseOthers() {
  std::vector<double> evaluated(solved_.begin(), solved_.end());
  for (std::size_t k = 0; k < light_.size(); ++k) {
    if (!isEvaluated(k / bands_)) evaluated[k] = 0;
  }
  const double before = reflectedPower(evaluated);
  const double ratio = before > 0 ? reflectedPower(light_) / before : 1;
  for (std::size_t k = 0; k < light_.size(); ++k) {
    if (!isEvaluated(k / bands_)) light_[k] = ratio * solved_[k];
  }
}

double IndirectSources::reflectedPower(std::span<const double> irradiance) const {
  double power = 0;
  for (std::size_t k = 0; k < irradiance.size(); ++k) {
    power += mesh_.area[k / bands_] * materials_.reflectance[k] * irradiance[k];
  }
  return power;
}

void IndirectSources::keepMeans() {
  for (std::size_t k = 0; k < added_.size(); ++k) added_[k] = solved_[k] - light_[k];
  light_.assign(solved_.begin(), solved_.end());
  gained_ = 0;
}

void IndirectSources::extrapolate() {
  const double left = gained_before_ != 0 ? gained_ / gained_before_ : 0;
  if (!(left > 0 && left < kMostLeft)) return;
  for (std::size_t k = 0; k < light_.size(); ++k) {
    const double more = left / (1 - left) * (light_[k] - before_[k]);
    added_[k] += more;
    light_[k] += more;
  }
}

void IndirectSources::add(std::size_t root, Vec2 at, std::span<double> sum) const {
  const std::size_t k = surface_.roots.patch[root] * bands_;
  const bool evaluated = lookup_.add(field_, root, at, sum);
  for (std::size_t b = 0; b < bands_; ++b) {
    sum[b] += evaluated ? added_[k + b] : light_[k + b];
  }
}

}  // namespace radiosity
