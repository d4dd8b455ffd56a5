#include "formfactor/rays/seen_patches.h"

#include <tbb/enumerable_thread_specific.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/made.h"
#include "base/parallel.h"
#include "formfactor/patch_seed.h"
#include "formfactor/rays/cluster_features.h"

namespace radiosity {
namespace {

using Vector = ClusterFeatures::Vector;
using Square = ClusterFeatures::Square;
using Axes = Eigen::Matrix<double, Eigen::Dynamic, ClusterFeatures::kCount>;

/// Axes with less spread than this share of ClusterFeatures::hold() are left out.
constexpr double kLeastSpread = 1e-3;

struct Item {
  std::uint32_t item;
  std::uint32_t hits = 0;
  Vector sum = Vector::Zero();  ///< of features
};

/// The view of one cluster.
struct Row {
  double size = 0;  ///< RayOrigins::size()
  std::uint32_t rays = 0;
  std::vector<Item> items;
  Vector sum = Vector::Zero();
  Square moments = Square::Zero();
  Axes axes = Axes(0, ClusterFeatures::kCount);
  Vector middle = Vector::Zero();

  void findAxes() {
    const Square spread = ClusterFeatures::spread(moments, sum, rays);
    const double hold = ClusterFeatures::hold(spread);
    const Eigen::SelfAdjointEigenSolver<Square> solver(spread);
    for (int k = 0; k < ClusterFeatures::kCount; ++k) {
      const double along = solver.eigenvalues()[k];
      if (along < kLeastSpread * hold) continue;
      axes.conservativeResize(axes.rows() + 1, Eigen::NoChange);
      axes.bottomRows<1>() =
          solver.eigenvectors().col(k).transpose() * std::sqrt(rays / (along + hold));
    }
  }
};

class Looks {
 public:
  explicit Looks(const PatchMesh& mesh)
      : mesh_(mesh),
        caster_(mesh, RayItems::patches),
        rows_(mesh.unknowns()),
        places_(std::vector<std::uint32_t>(mesh.size() + 1, kNone)) {}

  void run(Progress& progress) {
    const std::uint32_t rays = ClusterFeatures::rays(rows_.size());
    progress.begin("what clusters see", rows_.size());
    parallelFor(rows_.size(), 1, [&](std::size_t cluster) {
      if (progress.cancelled()) return;
      lookFrom(cluster, rays);
      progress.advance();
    });
    progress.check();
    progress.end();
  }

  SeenPatches gathered() const {
    SeenPatches seen;
    seen.begin.push_back(0);
    for (const Row& row : rows_) append(row, seen);
    for (std::size_t i = 0; i < mesh_.size(); ++i) appendPatch(Index(i), seen);
    return seen;
  }

 private:
  void lookFrom(std::size_t cluster, std::uint32_t rays) {
    const std::span<const Index> patches = made(mesh_.clusters).patchesOf(cluster);
    const RayOrigins origins = caster_.origins(cluster);
    if (origins.empty()) return;
    Row& row = rows_[cluster];
    row.size = origins.size();
    const ClusterFeatures features(mesh_, caster_, row.size);
    std::vector<std::uint32_t>& place = places_.local();
    const std::uint32_t sky = std::uint32_t(caster_.items());
    caster_.visitEnds(origins, patchSeed(mesh_, patches[0], 0), rays,
                      [&](const glm::vec3& from, const glm::vec3& normal, std::uint32_t end) {
                        const Vector f = features.at(from, normal);
                        ++row.rays;
                        row.sum += f;
                        row.moments += f * f.transpose();
                        if (end >= mesh_.size() && end != sky) return;  // a back
                        const auto item = std::uint32_t(std::min<std::size_t>(end, mesh_.size()));
                        if (place[item] == kNone) {
                          place[item] = std::uint32_t(row.items.size());
                          row.items.push_back({item});
                        }
                        ++row.items[place[item]].hits;
                        row.items[place[item]].sum += f;
                      });
    for (const Item& item : row.items) place[item.item] = kNone;
    std::ranges::sort(row.items, {}, &Item::item);
    if (patches.size() < 2 || row.rays <= ClusterFeatures::kCount + 1) return;
    row.middle = features.middleOf(patches);
    row.findAxes();
  }

  static void append(const Row& row, SeenPatches& seen) {
    seen.rays.push_back(row.rays);
    seen.axes.push_back(std::uint8_t(row.axes.rows()));
    for (const Item& item : row.items) {
      seen.item.push_back(item.item);
      seen.hits.push_back(item.hits);
      appendValues(row.axes * (item.sum / item.hits - row.sum / row.rays), seen.mean);
    }
    seen.begin.push_back(std::uint32_t(seen.item.size()));
  }

  void appendPatch(Index i, SeenPatches& seen) const {
    const std::size_t cluster = mesh_.unknownOf(i);
    const Row& row = rows_[cluster];
    if (row.axes.rows() == 0) return;
    const ClusterFeatures features(mesh_, caster_, row.size);
    appendValues(row.axes * (features.ofPatch(i) - row.middle), seen.patch);
  }

  static void appendValues(const Eigen::VectorXd& values, std::vector<float>& to) {
    for (const double value : values) to.push_back(float(value));
  }

  const PatchMesh& mesh_;
  RayCaster caster_;
  std::vector<Row> rows_;
  /// Of each thread: where an item, or the sky after all patches, is in its row's items; else
  /// kNone.
  tbb::enumerable_thread_specific<std::vector<std::uint32_t>> places_;
};

}  // namespace

SeenPatches seenPatches(const PatchMesh& mesh, Progress& progress) {
  Looks looks(mesh);
  looks.run(progress);
  return looks.gathered();
}

}  // namespace radiosity
