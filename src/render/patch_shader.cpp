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
  patch_ = patch;
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
  const PointMaterials* materials = field_.roots->materials;
  varies_ = materials != nullptr && materials->varies(patch);
  normal_ = mesh_.normal[patch];
  height_ = glm::dot(normal_, mesh_.vertices[roots.corner[root][0]] - items_.view().eye);
}

void PatchShader::addIrradiance(const Vec3& at, std::span<double> direct,
                                std::span<double> indirect, Shade& shade) {
  const ShadedRoots& shaded = *field_.roots;
  if (shaded.points == nullptr) {
    const Vec2 place = shaded.lookup->place(root_, at);
    shaded.lookup->add(shaded.elements->direct, root_, place, direct);
    shaded.lookup->add(shaded.elements->indirect, root_, place, indirect);
    return;
  }
  const int rays = int(std::bit_floor(unsigned(
      std::clamp(shaded.rays / samples_, LightAtPoints::kFewestRays, LightAtPoints::kMostRays))));
  shade.noise_square = shaded.points->add(root_, at, rays, direct, indirect);
  for (std::size_t b = 0; b < direct.size(); ++b) shade.light += direct[b] + indirect[b];
  ++sums_.points;
  sums_.rays += rays;
  sums_.noise_square += shade.noise_square / (samples_ * samples_);
  sums_.light_square += shade.light * shade.light / samples_;
}

/// Samples are as far apart on the patch as in the picture, at its depth; more where it is seen
/// aslant, in one direction.
PointMaterials::Values PatchShader::materialAt(const Vec3& at, double depth) const {
  const View& view = items_.view();
  const double facing = std::abs(glm::dot(normal_, glm::normalize(at - view.eye)));
  const double across = depth / (view.focal * items_.samples());
  return field_.roots->materials->at(patch_, at, across / std::sqrt(std::max(facing, 0.1)));
}

Shade PatchShader::rootAt(double x, double y) {
  const ShadedRoots& shaded = *field_.roots;
  const Vec3 ray = items_.view().rayThrough(x, y);
  const double depth = height_ / glm::dot(normal_, ray);
  const Vec3 at = items_.view().eye + ray * depth;
  Shade shade;
  std::array<double, 3> direct{};
  std::array<double, 3> indirect{};
  const auto bands = std::size_t(shaded.bands);
  addIrradiance(at, std::span(direct).first(bands), std::span(indirect).first(bands), shade);
  const PointMaterials::Values own = varies_ ? materialAt(at, depth) : PointMaterials::Values();
  for (std::size_t b = 0; b < bands; ++b) {
    const std::size_t k = patch_ * bands + b;
    const double reflectance = varies_ ? own.reflectance[int(b)] : shaded.reflectance[k];
    const double emission =
        varies_ ? shaded.emission[k] * own.emission_factor[int(b)] : shaded.emission[k];
    shade.albedo[b] = reflectance;
    shade.direct[b] = shaded.factor * (emission + reflectance * direct[b]);
    shade.value[b] = shaded.factor * (emission + reflectance * (direct[b] + indirect[b]));
  }
  if (bands == 1) {
    for (auto* grey : {&shade.value, &shade.direct, &shade.albedo}) grey->fill((*grey)[0]);
  }
  return shade;
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

Shade PatchShader::at(double x, double y) { return root_ != kNone ? rootAt(x, y) : patchAt(x, y); }

/// Of a patch without light on its roots all counts as indirect, less what it emits.
Shade PatchShader::patchAt(double x, double y) const {
  Shade shade;
  shade.value = interpolated(x, y);
  if (field_.roots == nullptr) return shade;
  const ShadedRoots& shaded = *field_.roots;
  for (std::size_t b = 0; b < 3; ++b) {
    const std::size_t k = patch_ * std::size_t(shaded.bands) + (shaded.bands == 1 ? 0 : b);
    shade.albedo[b] = shaded.reflectance[k];
    shade.direct[b] = shaded.factor * shaded.emission[k];
  }
  return shade;
}

std::array<double, 3> PatchShader::interpolated(double x, double y) const {
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
