#include "formfactor/rays/patch_irradiance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <bit>
#include <numbers>

#include "base/made.h"
#include "base/parallel.h"
#include "formfactor/patch_seed.h"
#include "formfactor/rays/ray_caster.h"

namespace radiosity {
namespace {

/// Place and normal.
constexpr int kFeatures = 6;
using Features = Eigen::Matrix<double, kFeatures, 1>;
using Square = Eigen::Matrix<double, kFeatures, kFeatures>;

/// Rays of all clusters together, about, and of one of them in each replicate.
constexpr double kAllRays = 1u << 24;
constexpr double kFewestRays = 256;
constexpr double kMostRays = 8192;
/// Of the spread of the strongest feature: a feature that spreads less (what is normal to a plane)
/// is held by so much.
constexpr double kHeld = 1e-6;

Features featuresOf(const glm::vec3& place, const glm::vec3& normal, double size) {
  Features f;
  f << place.x / size, place.y / size, place.z / size, normal.x, normal.y, normal.z;
  return f;
}

/// Sums over rays.
struct Fit {
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

  void add(const Features& features, const double* value) {
    rays += 1;
    sum += features;
    moments += features * features.transpose();
    for (Eigen::Index b = 0; b < values.size(); ++b) {
      values[b] += value[b];
      squares[b] += value[b] * value[b];
      products.col(b) += value[b] * features;
    }
  }

  /// Of each band, a column.
  Eigen::MatrixXd slopes() const {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(kFeatures, values.size());
    if (rays <= kFeatures + 1) return result;
    Square spread = moments - sum * sum.transpose() / rays;
    spread.diagonal().array() += kHeld * std::max(spread.diagonal().maxCoeff(), 1e-30);
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

class Gradients {
 public:
  Gradients(const PatchMesh& mesh, std::span<const double> radiosity,
            std::span<const double> irradiance, int bands, std::span<const double> sky)
      : mesh_(mesh),
        caster_(mesh),
        irradiance_(irradiance),
        bands_(std::size_t(bands)),
        of_item_(radiosity.begin(), radiosity.end()) {
    of_item_.resize((caster_.items() + 1) * bands_, 0.0);  // backs are black; the last is the sky
    for (std::size_t b = 0; b < sky.size(); ++b) {
      of_item_[caster_.items() * bands_ + b] = std::numbers::pi * sky[b];
    }
    const double rays = kAllRays / (kReplicates * double(mesh.unknowns()));
    rays_ = std::bit_floor(std::uint32_t(std::clamp(rays, kFewestRays, kMostRays)));
  }

  void run(std::size_t cluster, std::vector<double>& out) const {
    const std::span<const Index> patches = made(mesh_.clusters).patchesOf(cluster);
    const double* mean = irradiance_.data() + cluster * bands_;
    for (const Index i : patches) std::copy_n(mean, bands_, out.data() + i * bands_);
    if (patches.size() < 2) return;
    const RayOrigins origins = caster_.origins(cluster);
    if (origins.empty()) return;
    const double size = std::max(origins.size(), 1e-12);
    Fit fit{int(bands_)};
    caster_.visitEnds(origins, patchSeed(mesh_, patches[0], 0), rays_,
                      [&](const glm::vec3& from, const glm::vec3& normal, std::uint32_t item) {
                        fit.add(featuresOf(from, normal, size), of_item_.data() + item * bands_);
                      });
    apply(patches, fit.slopes(), size, out);
  }

 private:
  void apply(std::span<const Index> patches, const Eigen::MatrixXd& slopes, double size,
             std::vector<double>& out) const {
    const auto features = [&](Index i) {
      return featuresOf(caster_.place(mesh_.centroid[i]), glm::vec3(mesh_.normal[i]), size);
    };
    double area = 0;
    Features middle = Features::Zero();
    for (const Index i : patches) {
      area += mesh_.area[i];
      middle += mesh_.area[i] * features(i);
    }
    if (!(area > 0)) return;
    middle /= area;
    for (std::size_t b = 0; b < bands_; ++b) {
      const double mean = out[patches[0] * bands_ + b];
      double sum = 0;
      for (const Index i : patches) {
        double& value = out[i * bands_ + b];
        value = std::max(0.0, mean + slopes.col(Eigen::Index(b)).dot(features(i) - middle));
        sum += mesh_.area[i] * value;
      }
      // What was cut off at 0 has raised the mean.
      if (!(sum > 0)) continue;
      for (const Index i : patches) out[i * bands_ + b] *= mean * area / sum;
    }
  }

  const PatchMesh& mesh_;
  RayCaster caster_;
  std::span<const double> irradiance_;
  std::size_t bands_;
  std::vector<double> of_item_;  ///< radiosity, a row an item, then that of the sky
  std::uint32_t rays_ = 0;
};

}  // namespace

std::vector<double> patchIrradiance(const PatchMesh& mesh, std::span<const double> radiosity,
                                    std::span<const double> irradiance, int bands,
                                    std::span<const double> sky, Progress& progress) {
  const Gradients gradients(mesh, radiosity, irradiance, bands, sky);
  std::vector<double> out(mesh.size() * std::size_t(bands), 0.0);
  progress.begin("irradiance of patches", mesh.unknowns());
  parallelFor(mesh.unknowns(), 1, [&](std::size_t cluster) {
    if (progress.cancelled()) return;
    gradients.run(cluster, out);
    progress.advance();
  });
  progress.check();
  progress.end();
  return out;
}

}  // namespace radiosity
