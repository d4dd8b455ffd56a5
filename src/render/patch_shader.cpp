#include "render/patch_shader.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

namespace radiosity {

PatchShader::PatchShader(const PatchMesh& mesh, const ItemBuffer& items, const PatchField& field)
    : mesh_(mesh), items_(items), field_(field) {}

void PatchShader::setPiece(Index piece) {
  const Index patch = items_.patchOf(piece);
  corners_ = 0;
  setRoot(patch, piece);
  if (root_ != kNone) return;
  if (field_.corners.empty()) {
    for (int b = 0; b < field_.bands; ++b) {
      base_[b] = field_.values[std::size_t(patch) * field_.bands + b];
    }
    return;
  }
  if (convexQuad(patch)) {
    setConvexQuad(patch);
  } else {
    setTriangle(patch, piece);
  }
}

void PatchShader::setSamples(int samples) { samples_ = samples; }

void PatchShader::setRoot(Index patch, Index piece) {
  root_ = kNone;
  if (field_.roots == nullptr) return;
  const ElementRoots& roots = field_.roots->roots;
  const std::size_t first = roots.of_patch[patch];
  const std::size_t count = roots.of_patch[patch + 1] - first;
  if (count == 0) return;
  // A patch with several roots has one for each piece.
  const std::size_t root = count == 1 ? first : first + (piece - mesh_.piece_offset[patch]);
  const Elements* elements = field_.roots->elements;
  if (elements != nullptr && elements->indirect.elements[root].corners == 0) return;
  root_ = root;
  patch_ = patch;
  const PointMaterials* materials = field_.roots->materials;
  varies_ = materials != nullptr && materials->varies(patch);
  normal_ = mesh_.normal[patch];
  height_ = glm::dot(normal_, mesh_.vertices[roots.corner[root][0]] - items_.view().eye);
}

void PatchShader::irradiance(const Vec3& at, std::span<double> sum) {
  const ShadedRoots& shaded = *field_.roots;
  if (shaded.points == nullptr) {
    const Vec2 place = shaded.lookup->place(root_, at);
    shaded.lookup->add(shaded.elements->direct, root_, place, sum);
    shaded.lookup->add(shaded.elements->indirect, root_, place, sum);
    return;
  }
  const int rays = int(std::bit_floor(unsigned(
      std::clamp(shaded.rays / samples_, LightAtPoints::kFewestRays, LightAtPoints::kMostRays))));
  const double noise = shaded.points->add(root_, at, rays, sum);
  double light = 0;
  for (const double value : sum) light += value;
  ++sums_.points;
  sums_.rays += rays;
  sums_.noise_square += noise / (samples_ * samples_);
  sums_.light_square += light * light / samples_;
}

/// Samples are as far apart on the patch as in the picture, at its depth; more where it is seen
/// aslant, in one direction.
PointMaterials::Values PatchShader::materialAt(const Vec3& at, double depth) const {
  const View& view = items_.view();
  const double facing = std::abs(glm::dot(normal_, glm::normalize(at - view.eye)));
  const double across = depth / (view.focal * items_.samples());
  return field_.roots->materials->at(patch_, at, across / std::sqrt(std::max(facing, 0.1)));
}

std::array<double, 3> PatchShader::rootAt(double x, double y) {
  const ShadedRoots& shaded = *field_.roots;
  const Vec3 ray = items_.view().rayThrough(x, y);
  const double depth = height_ / glm::dot(normal_, ray);
  const Vec3 at = items_.view().eye + ray * depth;
  std::array<double, 3> light{};
  const auto bands = std::size_t(shaded.bands);
  irradiance(at, std::span(light).first(bands));
  if (varies_) {
    const PointMaterials::Values own = materialAt(at, depth);
    for (int b = 0; b < 3; ++b) {
      const double emission = shaded.emission[patch_ * bands + std::size_t(b)];
      light[b] =
          shaded.factor * (emission * own.emission_factor[b] + own.reflectance[b] * light[b]);
    }
    return light;
  }
  for (std::size_t b = 0; b < bands; ++b) {
    const std::size_t k = patch_ * bands + b;
    light[b] = shaded.factor * (shaded.emission[k] + shaded.reflectance[k] * light[b]);
  }
  if (bands == 1) light[1] = light[2] = light[0];
  return light;
}

/// Fills the corner areas; false unless the patch is a convex quadrilateral.
bool PatchShader::convexQuad(Index patch) {
  const auto outline = mesh_.outline(patch);
  if (outline.size() != 4) return false;
  for (int k = 0; k < 4; ++k) {
    const Vec3& before = mesh_.vertices[outline[(k + 3) % 4]];
    const Vec3& corner = mesh_.vertices[outline[k]];
    const Vec3& after = mesh_.vertices[outline[(k + 1) % 4]];
    area_[k] = glm::dot(glm::cross(corner - before, after - corner), mesh_.normal[patch]);
    if (!(area_[k] > 0)) return false;
  }
  return true;
}

void PatchShader::setConvexQuad(Index patch) {
  const auto outline = mesh_.outline(patch);
  const std::size_t first = mesh_.corner_offset[patch];
  corners_ = 4;
  for (int k = 0; k < 4; ++k) {
    edge_[k] = items_.edgeFunction(outline[k], outline[(k + 1) % 4]);
    for (int b = 0; b < field_.bands; ++b) {
      const double value = field_.corners[(first + k) * field_.bands + b];
      if (k == 0) base_[b] = value;
      rise_[k][b] = value - base_[b];
    }
  }
}

void PatchShader::setTriangle(Index patch, Index piece) {
  const auto outline = mesh_.outline(patch);
  const std::size_t first = mesh_.corner_offset[patch];
  const auto& p = mesh_.pieces[piece];
  corners_ = 3;
  for (int k = 0; k < 3; ++k) {
    edge_[k] = items_.edgeFunction(p[k], p[(k + 1) % 3]);
    const auto found = std::find(outline.begin(), outline.end(), p[k]);
    // A piece may have a vertex inside the patch, which has the patch's own value.
    const bool on_outline = found != outline.end();
    const std::size_t corner = first + std::size_t(found - outline.begin());
    for (int b = 0; b < field_.bands; ++b) {
      const double value = on_outline ? field_.corners[corner * field_.bands + b]
                                      : field_.values[std::size_t(patch) * field_.bands + b];
      if (k == 0) base_[b] = value;
      rise_[k][b] = value - base_[b];
    }
  }
}

std::array<double, 3> PatchShader::at(double x, double y) {
  if (root_ != kNone) return rootAt(x, y);
  std::array<double, 3> value = base_;
  if (corners_ == 0) return value;
  std::array<double, 4> a{};
  for (int k = 0; k < corners_; ++k) {
    // In a quadrilateral that is planar only up to coincidence, rounding may put a point outside.
    a[k] = std::max(edge_[k].x * x + edge_[k].y * y + edge_[k].z, 0.0);
  }
  std::array<double, 4> w{};
  double sum = 0;
  for (int k = 0; k < corners_; ++k) {
    w[k] = corners_ == 4 ? area_[k] * a[(k + 1) % 4] * a[(k + 2) % 4] : a[(k + 1) % 3];
    sum += w[k];
  }
  if (!(sum > 0)) return value;  // the patch is seen as a point
  // Differences to one corner, so that a constant field keeps its bits.
  for (int k = 1; k < corners_; ++k) {
    for (int b = 0; b < field_.bands; ++b) value[b] += w[k] / sum * rise_[k][b];
  }
  return value;
}

}  // namespace radiosity
