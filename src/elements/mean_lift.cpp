#include "elements/mean_lift.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "elements/element_parts.h"

namespace radiosity {
namespace {

/// Factor for the sum of second differences over all cells at a vertex: see the header.
constexpr double kOfQuarters = 1.0 / 24;
constexpr double kOfTriangles = 1.0 / 48;
/// A vertex is surrounded if the angles of its cells sum to at least this. They sum to 2 pi all
/// around a vertex, to a little less on a curved surface, and to 3/2 pi at an inner corner of a
/// polygon.
constexpr double kAllAround = 1.75 * std::numbers::pi;
/// Neighbours are balanced if the length of the sum of their offsets is at most this share of the
/// sum of their distances.
constexpr double kBalanced = 0.05;
/// Share of light beyond which a bend is taken for a kink.
constexpr double kKink = 0.01;

class MeanLift {
 public:
  MeanLift(ElementField& field, std::span<const SurfacePoint> points, std::size_t bands)
      : field_(field), points_(points), bands_(bands), bend_(points.size() * bands, 0.0) {}

  void lift(std::span<const double> light) {
    measureBends();
    findLifted(light);
    const std::vector<double> smooth = averagedBends();
    for (std::size_t v = 0; v < points_.size(); ++v) {
      if (lifted_[v] == 0) continue;
      for (std::size_t b = v * bands_; b < (v + 1) * bands_; ++b) field_.values[b] -= smooth[b];
    }
  }

 private:
  /// Calls `cell` with the vertices of each cell.
  template <class Call>
  void forCells(const Call& cell) const {
    for (const Element& element : field_.elements) {
      if (element.first_child != kNone || element.corners == 0) continue;
      const std::span<const Index> p =
          std::span(field_.points)
              .subspan(element.first_point, pointCount(element.corners, element.tested != 0));
      if (element.tested == 0) {
        cell(p);
        continue;
      }
      for (const PartCorners& part : partsOf(element.corners)) {
        const std::array<Index, 4> vertex = {p[part[0]], p[part[1]], p[part[2]], p[part[3]]};
        cell(std::span(vertex).first(element.corners));
      }
    }
  }

  void measureBends() {
    around_.resize(points_.size());
    forCells([&](std::span<const Index> cell) {
      const std::size_t n = cell.size();
      for (std::size_t k = 0; k < n; ++k) {
        addCorner(cell[k], cell[(k + 1) % n], cell[(k + n - 1) % n],
                  n == 4 ? kOfQuarters : kOfTriangles);
      }
    });
  }

  void addCorner(Index vertex, Index next, Index last, double share) {
    const Vec3 a = points_[next].place - points_[vertex].place;
    const Vec3 b = points_[last].place - points_[vertex].place;
    Surroundings& around = around_[vertex];
    around.offset += a + b;
    around.reach += glm::length(a) + glm::length(b);
    around.angle += std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
    for (std::size_t k = 0; k < bands_; ++k) {
      bend_[vertex * bands_ + k] +=
          share * (valueOf(next, k) + valueOf(last, k) - 2 * valueOf(vertex, k));
    }
  }

  void findLifted(std::span<const double> light) {
    lifted_.assign(points_.size(), 0);
    for (std::size_t v = 0; v < points_.size(); ++v) {
      const Surroundings& around = around_[v];
      double bend = 0;
      for (std::size_t k = 0; k < bands_; ++k) bend += std::abs(bend_[v * bands_ + k]);
      const bool balanced = glm::length(around.offset) <= kBalanced * around.reach;
      lifted_[v] = around.angle > kAllAround && balanced && bend <= kKink * light[v] ? 1 : 0;
    }
  }

  /// The mean bend over the lifted corners of each vertex's cells.
  std::vector<double> averagedBends() const {
    std::vector<double> sum(bend_.size(), 0.0);
    std::vector<double> count(points_.size(), 0.0);
    forCells([&](std::span<const Index> cell) {
      for (const Index to : cell) {
        for (const Index from : cell) {
          if (lifted_[from] == 0) continue;
          count[to] += 1;
          for (std::size_t k = 0; k < bands_; ++k) {
            sum[to * bands_ + k] += bend_[from * bands_ + k];
          }
        }
      }
    });
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] /= std::max(1.0, count[k / bands_]);
    return sum;
  }

  double valueOf(Index vertex, std::size_t band) const {
    return field_.values[vertex * bands_ + band];
  }

  /// Sums over the neighbours of a vertex; each counts once for every cell that has it beside the
  /// vertex.
  struct Surroundings {
    Vec3 offset{0.0};  ///< sum of their offsets from the vertex, metres
    double reach = 0;  ///< sum of their distances
    double angle = 0;  ///< of all cells there
  };

  ElementField& field_;
  std::span<const SurfacePoint> points_;
  std::size_t bands_;
  std::vector<double> bend_;  ///< V * bands: the height of values above the mean, W/m^2
  std::vector<Surroundings> around_;
  std::vector<std::uint8_t> lifted_;
};

}  // namespace

void liftToMeans(ElementField& field, std::span<const SurfacePoint> points,
                 std::span<const double> light, std::size_t bands) {
  MeanLift(field, points, bands).lift(light);
}

}  // namespace radiosity
