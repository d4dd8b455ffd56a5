#include "formfactor/rays/ray_caster.h"

#include <algorithm>
#include <cmath>

namespace radiosity {
namespace {

/// The end of a ray that is no item.
constexpr std::uint32_t kSky = kNone - 1;
/// Rays that are sorted together, at most: their batch fits the second-level cache.
constexpr std::size_t kBatch = 16384;
/// Cells of directions: kBatch points put about one packet into each.
constexpr std::size_t kCells = std::size_t(kDirectionCells) * kDirectionCells;
}  // namespace

/// Rays that are sorted together: those of all replicates, one replicate after the other.
struct RayCaster::Batch {
  std::size_t each = 0;  ///< rays of a replicate
  std::array<std::array<float, kBatch>, kDimensions> points;
  std::array<std::array<float, kBatch>, 3> origin;
  std::array<std::array<float, kBatch>, 3> direction;
  std::array<std::int32_t, kBatch> part;  ///< of the origins, of each ray
  std::array<std::uint16_t, kBatch> cell;
  std::array<std::uint16_t, kBatch> order;

  std::size_t size() const { return kReplicates * each; }
  /// The same filled up to whole packets.
  std::size_t padded() const { return (size() + kRayLanes - 1) / kRayLanes * kRayLanes; }

  /// Points `first` to `first + each` of every replicate's sequence.
  void place(const SobolPoints& sobol, std::uint64_t seed, std::uint32_t first) {
    for (std::size_t r = 0; r < kReplicates; ++r) {
      for (std::size_t done = 0; done < each;) {
        const std::uint32_t from = first + std::uint32_t(done);
        const std::size_t even = from == 0 ? kMostPoints : from & (~from + 1);
        const std::size_t count = std::min({even, kMostPoints, each - done});
        PointArrays out{};
        for (std::size_t d = 0; d < kDimensions; ++d) out[d] = &points[d][r * each + done];
        sobol.points(from, count, seed + r, out);
        done += count;
      }
    }
    for (std::array<float, kBatch>& values : points) {
      std::fill(values.begin() + std::ptrdiff_t(size()), values.begin() + std::ptrdiff_t(padded()),
                0.0F);
    }
  }

  void aim(const RayOrigins& origins, const RayKernels& kernels) {
    if (origins.parts() == 1) {
      std::fill_n(part.begin(), padded(), 0);
    } else {
      for (std::size_t k = 0; k < padded(); ++k) {
        part[k] = std::int32_t(origins.partAt(points[0][k], points[0][k]));
      }
    }
    kernels.aim(origins, size(), arrays(origins));
  }

  RayArrays arrays(const RayOrigins& origins) {
    return {{points[0].data(), points[1].data(), points[2].data(), points[3].data()},
            origins.parts() == 1 ? nullptr : part.data(),
            {origin[0].data(), origin[1].data(), origin[2].data()},
            {direction[0].data(), direction[1].data(), direction[2].data()},
            cell.data()};
  }

  glm::vec3 from(std::size_t ray) const { return {origin[0][ray], origin[1][ray], origin[2][ray]}; }
  glm::vec3 along(std::size_t ray) const {
    return {direction[0][ray], direction[1][ray], direction[2][ray]};
  }

  /// The order in which rays leave together: by direction.
  void sort() {
    std::array<std::uint16_t, kCells + 1> start{};
    for (std::size_t k = 0; k < size(); ++k) ++start[cell[k] + 1u];
    for (std::size_t c = 1; c < start.size(); ++c) {
      start[c] = std::uint16_t(start[c] + start[c - 1]);
    }
    for (std::size_t k = 0; k < size(); ++k) order[start[cell[k]]++] = std::uint16_t(k);
    std::fill(order.begin() + std::ptrdiff_t(size()), order.begin() + std::ptrdiff_t(padded()),
              order[size() - 1]);
  }
};

RayCaster::RayCaster(const PatchMesh& mesh)
    : mesh_(mesh),
      scene_(mesh),
      embree_(scene_, mesh),
      targets_(scene_, embree_),
      kernels_(rayKernels()) {}

RayOrigins RayCaster::origins(std::size_t patch) const {
  return {mesh_, patch, scene_.scale, embree_.middle()};
}

bool RayCaster::canAim(const RayOrigins& origins) const {
  return !embree_.isNearPolygon(origins.polygon());
}

std::size_t RayCaster::bytes() const {
  // Embree's tree takes about this much a triangle in robust mode.
  constexpr std::size_t kTreeBytes = 160;
  return scene_.bytes() + targets_.bytes() + triangles() * kTreeBytes;
}

/// Calls visit(ray, item) with the ray's place in the batch; kSky stands for no item.
template <class Visit>
void RayCaster::tracePacket(const RayOrigins& origins, Batch& batch, const std::uint16_t* order,
                            int lanes, const Visit& visit) const {
  RTCRayHit16 packet;
  RayEnds ends;
  const Index own = origins.polygon();
  initPacket(packet);
  kernels_.fill(batch.arrays(origins), order, packet);
  embree_.trace(packet, lanes);
  kernels_.find(packet, targets_, ends);
  for (int k = 0; k < lanes; ++k) {
    const std::size_t ray = order[k];
    if (embree_.isNearPolygon(own)) {
      if (const auto end = embree_.endBefore(batch.from(ray), batch.along(ray), own)) {
        visit(ray, itemAt(*end));
        continue;
      }
    }
    if (packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) {
      visit(ray, kSky);
    } else if (ends.polygon[std::size_t(k)] == own) {
      // By rounding alone: at grazing angles, or where it is very thin.
      const auto end = embree_.endBeyond(batch.from(ray), batch.along(ray), own);
      visit(ray, end ? itemAt(*end) : kSky);
    } else if (embree_.isNear(packet.hit.primID[k])) {
      visit(ray, itemAt(embree_.endAt(packet, k, own)));
    } else {
      visit(ray, targets_.itemOf(ends, std::size_t(k)));
    }
  }
}

void RayCaster::cast(const RayOrigins& origins, std::uint64_t seed, std::uint32_t first,
                     std::uint32_t last, std::array<Counts, kReplicates>& of_replicate) const {
  if (origins.empty()) return;
  const FlushDenormals flush;
  const auto batch = std::make_unique_for_overwrite<Batch>();
  while (first < last) {
    batch->each = std::min<std::size_t>(last - first, kBatch / kReplicates);
    batch->place(sobol_, seed, first);
    batch->aim(origins, kernels_);
    batch->sort();
    for (std::size_t k = 0; k < batch->size(); k += kRayLanes) {
      const int lanes = int(std::min<std::size_t>(batch->size() - k, kRayLanes));
      tracePacket(origins, *batch, batch->order.data() + k, lanes,
                  [&](std::size_t ray, std::uint32_t item) {
                    Counts& counts = of_replicate[ray < batch->each ? 0 : 1];
                    if (item == kSky) {
                      ++counts.sky;
                    } else {
                      counts.add(item, 1);
                    }
                  });
    }
    first += std::uint32_t(batch->each);
  }
}

}  // namespace radiosity
