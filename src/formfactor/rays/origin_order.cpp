#include "formfactor/rays/origin_order.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <tuple>

#include "base/geometry/box.h"

namespace radiosity {
namespace {

/// Place and normal; places are in extents of all patches, so that both spread alike.
constexpr std::size_t kFeatures = 6;

struct Origin {
  Index patch = 0;
  double area = 0;
  std::array<double, kFeatures> at{};
};

double areaOf(std::span<const Origin> origins) {
  double sum = 0;
  for (const Origin& o : origins) sum += o.area;
  return sum;
}

std::size_t widestFeature(std::span<const Origin> origins) {
  const double area = areaOf(origins);
  std::size_t widest = 0;
  double most = -1;
  for (std::size_t f = 0; f < kFeatures; ++f) {
    double mean = 0;
    for (const Origin& o : origins) mean += o.area * o.at[f];
    mean /= area;
    double spread = 0;
    for (const Origin& o : origins) {
      spread += o.area * (o.at[f] - mean) * (o.at[f] - mean);
    }
    if (spread > most) {
      most = spread;
      widest = f;
    }
  }
  return widest;
}

/// Parts origins by a feature so that those before the place returned have half of the area, as
/// nearly as whole origins allow; neither side is empty. At least two origins.
std::size_t halve(std::span<Origin> origins, std::size_t feature) {
  // By the other features where this one is the same: faces of a box have few normals.
  const auto isBefore = [feature](const Origin& a, const Origin& b) {
    return std::tie(a.at[feature], a.at, a.patch) < std::tie(b.at[feature], b.at, b.patch);
  };
  const double half = 0.5 * areaOf(origins);
  std::size_t low = 0;  // the half ends between low and high
  std::size_t high = origins.size();
  double before = 0;  // area below low
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    const auto begin = origins.begin();
    std::nth_element(begin + std::ptrdiff_t(low), begin + std::ptrdiff_t(middle),
                     begin + std::ptrdiff_t(high), isBefore);
    const double area = before + areaOf(origins.subspan(low, middle - low));
    if (area < half) {
      before = area;
      low = middle;
    } else {
      high = middle;
    }
  }
  const std::size_t end = before + 0.5 * origins[low].area < half ? low + 1 : low;
  return std::clamp<std::size_t>(end, 1, origins.size() - 1);
}

void sortOrigins(std::span<Origin> origins) {
  while (origins.size() > 1) {
    const std::size_t end = halve(origins, widestFeature(origins));
    sortOrigins(origins.first(end));
    origins = origins.subspan(end);
  }
}

}  // namespace

std::vector<Index> originOrder(const PatchMesh& mesh, std::span<const Index> patches) {
  Box3 box;
  for (const Index i : patches) box.add(mesh.centroid[i]);
  const double extent = std::max(box.diagonal(), 1e-300);
  std::vector<Origin> origins;
  origins.reserve(patches.size());
  for (const Index i : patches) {
    if (!(mesh.area[i] > 0)) continue;
    const Vec3 place = (mesh.centroid[i] - box.low) / extent;
    const Vec3& normal = mesh.normal[i];
    origins.push_back({i, mesh.area[i], {place.x, place.y, place.z, normal.x, normal.y, normal.z}});
  }
  sortOrigins(origins);
  std::vector<Index> order;
  order.reserve(origins.size());
  for (const Origin& o : origins) order.push_back(o.patch);
  std::ranges::copy_if(patches, std::back_inserter(order),
                       [&](Index i) { return !(mesh.area[i] > 0); });
  return order;
}

}  // namespace radiosity
