#include "formfactor/rays/ray_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <utility>

#include "base/geometry/box.h"
#include "base/geometry/box_tree.h"
#include "formfactor/border_share.h"
#include "formfactor/patch_seed.h"
#include "mesh/patches/canonical_order.h"
#include "mesh/patches/enclosures.h"

namespace radiosity {

namespace {

/// Rays between two checks for cancellation: some milliseconds.
constexpr std::uint32_t kSlice = 1u << 16;

/// Single precision moves origins by a rounding, and rays start kRayLift before them: what stands
/// beside a patch is seen wrongly from this far inside its border, in scenes of size 1.
constexpr double kUnresolved = 2 * kRayLift;
/// It tells where the border takes up this share of a patch.
constexpr double kNarrow = 0.02;
/// The sine between planes that are one.
constexpr double kParallel = 1e-6;

Box3 boxOfPatch(const PatchMesh& mesh, std::size_t patch) {
  Box3 box;
  for (const Index v : mesh.outline(patch)) box.add(mesh.vertices[v]);
  return box;
}

/// Whether something that is not in the plane of a patch comes within `width` of it.
bool standsBeside(const PatchMesh& mesh, std::size_t patch, double width, const BoxTree& patches) {
  const Vec3& normal = mesh.normal[patch];
  bool found = false;
  patches.query(boxOfPatch(mesh, patch).grown(width), [&](Index other) {
    const bool parallel = glm::length(glm::cross(normal, mesh.normal[other])) <= kParallel;
    const double height = glm::dot(normal, mesh.centroid[other] - mesh.centroid[patch]);
    found = !(parallel && std::abs(height) <= width);
    return !found;
  });
  return found;
}

/// By patch: the share of its area that lies beside something, within `width` of a border; 0 but
/// for patches that are hardly wider.
std::vector<double> unresolvedShares(const PatchMesh& mesh, double width) {
  std::vector<double> shares(mesh.size(), 0.0);
  std::vector<std::pair<std::size_t, double>> narrow;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const double share = borderShare(mesh, i, width);
    if (share > kNarrow) narrow.emplace_back(i, share);
  }
  if (narrow.empty()) return shares;
  std::vector<Box3> boxes;
  for (std::size_t i = 0; i < mesh.size(); ++i) boxes.push_back(boxOfPatch(mesh, i));
  const BoxTree patches(boxes);
  for (const auto& [i, share] : narrow) {
    if (standsBeside(mesh, i, width, patches)) shares[i] = share;
  }
  return shares;
}

/// Counts of this thread, all 0.
using Replicates = std::array<RayCaster::Counts, kReplicates>;
Replicates& emptyCounts(std::size_t items) {
  thread_local Replicates counts;
  for (RayCaster::Counts& of : counts) of.clear(items);
  return counts;
}

}  // namespace

RayScene::RayScene(const PatchMesh& mesh, std::uint64_t with_seed)
    : caster_(mesh), order_(canonicalOrder(mesh)), position_(order_.size()) {
  const std::vector<double> unresolved = unresolvedShares(mesh, kUnresolved / caster_.scale());
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const Index patch = order_[k];
    position_[patch] = Index(k);
    area_.push_back(mesh.area[patch]);
    seed_.push_back(patchSeed(mesh, patch, with_seed));
    unresolved_.push_back(unresolved[patch]);
  }
  std::optional<Enclosures> found;
  if (!enclosuresOf(mesh, found).closed) windows_.emplace(caster_.embree());
}

/// Aims rays at what they can meet where that takes up little of the hemisphere. Returns the share
/// of it that they then go into.
double RayScene::aim(RayOrigins& origins) const {
  if (!windows_) return 1;
  if (origins.empty()) return kSeesNothing;
  if (!caster_.canAim(origins)) return 1;
  const auto window = windows_->of(origins);
  if (!window) return 1;
  return window->empty() ? kSeesNothing : std::max(origins.aim(*window), kSeesNothing);
}

void RayScene::cast(std::size_t position, std::uint32_t rays, RayRow& row,
                    const Progress& progress) const {
  RayOrigins origins = caster_.origins(order_[position]);
  Replicates& counts = emptyCounts(caster_.items());
  row.window = aim(origins);
  if (row.window == kSeesNothing) {
    for (RayCaster::Counts& of : counts) of.sky += rays - row.rays;
    row.rays = rays;
  }
  for (std::uint32_t first = row.rays; first < rays;) {
    if (progress.cancelled()) return;
    const std::uint32_t last = std::min(rays, (first / kSlice + 1) * kSlice);
    caster_.cast(origins, seed_[position], first, last, counts);
    first = last;
  }
  row.rays = rays;
  addCounts(counts, row);
}

void RayScene::addCounts(std::array<RayCaster::Counts, kReplicates>& counts, RayRow& row) const {
  const std::size_t n = order_.size();
  for (std::size_t r = 0; r < kReplicates; ++r) {
    RayCaster::Counts& of = counts[r];
    for (std::size_t e = 0; e < row.columns.size(); ++e) {
      const Index column = row.columns[e];
      of.add(column < n ? order_[column] : column, row.hits[e][r]);
    }
    row.sky[r] += of.sky;
  }
  std::vector<Index> columns;
  for (const RayCaster::Counts& of : counts) {
    for (const std::uint32_t item : of.hit) columns.push_back(item < n ? position_[item] : item);
  }
  std::sort(columns.begin(), columns.end());
  columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
  // New vectors of just that size: a third of grown ones would be empty.
  row.columns.clear();
  row.hits.clear();
  row.columns.reserve(columns.size());
  row.hits.reserve(columns.size());
  for (const Index column : columns) {
    const std::size_t item = column < n ? order_[column] : column;
    row.columns.push_back(column);
    row.hits.push_back({counts[0].hits[item], counts[1].hits[item]});
  }
}

}  // namespace radiosity
