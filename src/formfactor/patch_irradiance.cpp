#include "formfactor/patch_irradiance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <numbers>

#include "base/made.h"
#include "base/parallel.h"
#include "formfactor/patch_seed.h"
#include "formfactor/rays/cluster_features.h"
#include "formfactor/rays/ray_caster.h"
#include "mesh/clusters/cluster_means.h"

namespace radiosity {
namespace {

using Features = ClusterFeatures::Vector;
using Square = ClusterFeatures::Square;

}  // namespace

struct PatchIrradiance::Rays {
  explicit Rays(const PatchMesh& mesh)
      : caster(mesh, RayItems::patches),
        of_each(ClusterFeatures::rays(mesh.unknowns())),
        ends(mesh.unknowns()) {}

  RayCaster caster;
  std::uint32_t of_each;              ///< of a cluster
  std::vector<RayCaster::Ends> ends;  ///< by cluster
};

/// Sums over rays.
struct PatchIrradiance::Fit {
  explicit Fit(int bands)
      : values(Eigen::VectorXd::Zero(bands)),
        squares(Eigen::VectorXd::Zero(bands)),
        products(Eigen::MatrixXd::Zero(kFeatures, bands)) {}

  double rays = 0;
  Features sum = Features::Zero();
  Square moments = Square::Zero();
  Eigen::VectorXd values;
  Eigen::VectorXd squares;
  Eigen::MatrixXd products;
  Eigen::VectorXd beyond = Eigen::VectorXd::Zero(values.size());  ///< sums of View::beyond

  void add(const Features& features, const double* value, const double* beyond_mean) {
    rays += 1;
    sum += features;
    moments += features * features.transpose();
    for (Eigen::Index b = 0; b < values.size(); ++b) {
      values[b] += value[b];
      squares[b] += value[b] * value[b];
      products.col(b) += value[b] * features;
      beyond[b] += beyond_mean[b];
    }
  }

  /// The slopes of each band, a column.
  Eigen::MatrixXd slopes() const {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(kFeatures, values.size());
    if (rays <= kFeatures + 1) return result;
    Square spread = ClusterFeatures::spread(moments, sum, rays);
    spread.diagonal().array() += ClusterFeatures::hold(spread);
    const Eigen::LDLT<Square> solver(spread);
    for (Eigen::Index b = 0; b < values.size(); ++b) {
      const Features with_value = products.col(b) - sum * (values[b] / rays);
      const Features slope = solver.solve(with_value);
      const double explained = slope.dot(with_value);
      const double all = squares[b] - values[b] * values[b] / rays;
      const double noise = std::max(0.0, all - explained) / (rays - kFeatures - 1);
      if (!(explained > kFeatures * noise)) continue;
      result.col(b) = slope * (1 - kFeatures * noise / explained);
    }
    return result;
  }
};

/// The light that rays find, a row an item, then that of the sky.
struct PatchIrradiance::View {
  std::vector<double> radiosity;
  std::vector<double> beyond;  ///< radiosity less its cluster's mean
};

PatchIrradiance::PatchIrradiance(const PatchMesh& mesh, int bands, std::span<const double> sky)
    : mesh_(mesh),
      rays_(std::make_unique<Rays>(mesh)),
      bands_(std::size_t(bands)),
      sky_(bands_, 0.0),
      slopes_(slopesOf(mesh.unknowns()), 0.0),
      beyond_(mesh.unknowns() * bands_, 0.0) {
  for (std::size_t b = 0; b < sky.size(); ++b) sky_[b] = std::numbers::pi * sky[b];
}
PatchIrradiance::~PatchIrradiance() = default;

void PatchIrradiance::look(std::span<const double> radiosity, Progress& progress) {
  View view{{radiosity.begin(), radiosity.end()}, {radiosity.begin(), radiosity.end()}};
  const std::vector<double> means =
      patchValues(mesh_, clusterMeans(mesh_, radiosity, int(bands_)), int(bands_));
  for (std::size_t k = 0; k < means.size(); ++k) view.beyond[k] -= means[k];
  for (std::vector<double>* of_item : {&view.radiosity, &view.beyond}) {
    of_item->resize((rays_->caster.items() + 1) * bands_, 0.0);  // backs are black
  }
  std::copy(sky_.begin(), sky_.end(), view.radiosity.end() - std::ptrdiff_t(bands_));
  progress.begin("light within clusters", mesh_.unknowns());
  parallelFor(mesh_.unknowns(), 1, [&](std::size_t cluster) {
    if (progress.cancelled()) return;
    lookFrom(cluster, view);
    progress.advance();
  });
  progress.check();
  progress.end();
}

void PatchIrradiance::lookFrom(std::size_t cluster, const View& view) {
  const std::span<const Index> patches = made(mesh_.clusters).patchesOf(cluster);
  const RayOrigins origins = rays_->caster.origins(cluster);
  if (origins.empty()) return;
  const ClusterFeatures features(mesh_, rays_->caster, origins.size());
  Fit fit{int(bands_)};
  rays_->caster.visitEnds(origins, patchSeed(mesh_, patches[0], 0), rays_->of_each,
                          rays_->ends[cluster],
                          [&](const glm::vec3& from, const glm::vec3& normal, std::uint32_t item) {
                            fit.add(features.at(from, normal), &view.radiosity[item * bands_],
                                    &view.beyond[item * bands_]);
                          });
  if (fit.rays == 0) return;
  for (std::size_t b = 0; b < bands_; ++b) {
    beyond_[cluster * bands_ + b] = fit.beyond[Eigen::Index(b)] / fit.rays;
  }
  if (patches.size() < 2) return;
  const Eigen::MatrixXd slopes = fit.slopes();
  std::copy_n(slopes.data(), slopes.size(), &slopes_[slopesOf(cluster)]);
}

std::vector<double> PatchIrradiance::around(std::span<const double> irradiance) const {
  std::vector<double> out = patchValues(mesh_, irradiance, int(bands_));
  for (double& value : out) value = std::max(value, 0.0);  // solvers are off by their tolerance
  parallelFor(mesh_.unknowns(), 16, [&](std::size_t cluster) { addSlopes(cluster, out); });
  return out;
}

/// Adds the slopes within a cluster to its patches, which have its mean so far.
void PatchIrradiance::addSlopes(std::size_t cluster, std::vector<double>& irradiance) const {
  const std::span<const Index> patches = made(mesh_.clusters).patchesOf(cluster);
  const RayOrigins origins = rays_->caster.origins(cluster);
  if (patches.size() < 2 || origins.empty()) return;
  double area = 0;
  for (const Index i : patches) area += mesh_.area[i];
  if (!(area > 0)) return;
  const ClusterFeatures features(mesh_, rays_->caster, origins.size());
  const Features middle = features.middleOf(patches);
  for (std::size_t b = 0; b < bands_; ++b) {
    const Eigen::Map<const Features> slopes(&slopes_[slopesOf(cluster) + b * kFeatures]);
    const double mean = irradiance[patches[0] * bands_ + b];
    double sum = 0;
    for (const Index i : patches) {
      double& value = irradiance[i * bands_ + b];
      value = std::max(0.0, mean + slopes.dot(features.ofPatch(i) - middle));
      sum += mesh_.area[i] * value;
    }
    // Cutting values off at 0 has raised the mean.
    if (!(sum > 0)) continue;
    for (const Index i : patches) irradiance[i * bands_ + b] *= mean * area / sum;
  }
}

}  // namespace radiosity
