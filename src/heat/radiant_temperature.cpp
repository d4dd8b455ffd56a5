#include "radiosity/radiant_temperature.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "radiosity/point_factors.h"

namespace radiosity {

namespace {

/// Projected area factors (ISO 7726:1998, table B.1): up or down, and the mean of front or back and
/// left or right.
struct PersonShape {
  double upright;
  double sideways;
};
constexpr PersonShape kStanding{0.08, (0.35 + 0.23) / 2};
constexpr PersonShape kSeated{0.18, (0.30 + 0.22) / 2};

/// Values of form factors that are held at a time.
constexpr std::size_t kMostFactors = std::size_t(1) << 23;

using Faces = std::array<double, kRadiantFaces>;

/// W/m^2: the mean of what falls on the faces.
double meanOver(const Faces& falling, const PersonShape& shape, Up up) {
  const std::size_t axis = up == Up::y ? 1 : 2;
  double sum = 0;
  double weights = 0;
  for (std::size_t face = 0; face < kRadiantFaces; ++face) {
    const double weight = face / 2 == axis ? shape.upright : shape.sideways;
    sum += weight * falling[face];
    weights += weight;
  }
  return sum / weights;
}

std::vector<double> leavingHeat(const PatchMesh& mesh, const HeatSolution& heat) {
  const auto bands = std::size_t(heat.bands);
  if (heat.radiosity.size() != bands * mesh.size()) {
    throw InputError(
        fmt::format("radiant temperatures: heat of {} patches is of another mesh than that of {}",
                    heat.radiosity.size() / bands, mesh.size()));
  }
  std::vector<double> sums(mesh.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const auto first = heat.radiosity.begin() + std::ptrdiff_t(i * bands);
    sums[i] = std::accumulate(first, first + std::ptrdiff_t(bands), 0.0);
  }
  return sums;
}

}  // namespace

RadiantTemperatures radiantTemperatures(const PatchMesh& mesh, const HeatSolution& heat,
                                        const HeatOptions& options, std::span<const Vec3> points,
                                        Up up, Progress& progress) {
  const std::vector<double> leaving = leavingHeat(mesh, heat);
  const double sky = options.sigma * std::pow(options.sky_temperature, 4);
  const auto temperature = [&](double falling) { return std::pow(falling / options.sigma, 0.25); };
  const std::size_t at_once = std::max<std::size_t>(
      1, kMostFactors / (kRadiantFaces * std::max<std::size_t>(1, mesh.size())));
  std::vector<double> factors;
  RadiantTemperatures found;
  for (std::size_t first = 0; first < points.size(); first += at_once) {
    std::vector<Vec3> at;
    std::vector<Vec3> normals;
    for (const Vec3& point : points.subspan(first, std::min(at_once, points.size() - first))) {
      for (std::size_t face = 0; face < kRadiantFaces; ++face) {
        Vec3 normal(0.0);
        normal[int(face / 2)] = face % 2 == 0 ? 1 : -1;
        at.push_back(point);
        normals.push_back(normal);
      }
    }
    factors.resize(at.size() * mesh.size());
    pointFormFactors(mesh, at, normals, factors, progress);
    for (std::size_t row = 0; row < at.size(); row += kRadiantFaces) {
      Faces falling{};
      double seen = 0;
      for (std::size_t face = 0; face < kRadiantFaces; ++face) {
        const double* f = &factors[(row + face) * mesh.size()];
        const double sum = std::accumulate(f, f + mesh.size(), 0.0);
        falling[face] = std::inner_product(leaving.begin(), leaving.end(), f, 0.0) +
                        sky * std::max(0.0, 1 - sum);
        found.plane.push_back(temperature(falling[face]));
        seen += sum / double(kRadiantFaces);
      }
      found.standing.push_back(temperature(meanOver(falling, kStanding, up)));
      found.seated.push_back(temperature(meanOver(falling, kSeated, up)));
      found.surfaces.push_back(seen);
    }
  }
  return found;
}

}  // namespace radiosity
