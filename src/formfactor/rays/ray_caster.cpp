#include "formfactor/rays/ray_caster.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/parallel.h"
#include "formfactor/rays/origin_order.h"

namespace radiosity {
namespace {

/// The end of a ray that is no item.
constexpr std::uint32_t kSky = kNone - 1;
/// Rays that are sorted together, at most: their batch fits the second-level cache.
constexpr std::size_t kBatch = 16384;
/// Cells of directions: kBatch points put about one packet into each.
constexpr std::size_t kCells = std::size_t(kDirectionCells) * kDirectionCells;
/// Rays from as many parts are not coherent although they leave in one direction. One by one, rays
/// of rows with 32 to 63 parts take .74 to 1.06 times as long as together, those with 256 and more
/// .68 to .79 times, and those with a single part 1.03 to 1.39 times (four scenes by others of .5
/// to 1.4 million triangles).
constexpr std::size_t kManyParts = 32;

std::vector<Index> orderedClusters(const PatchMesh& mesh) {
  if (!mesh.clusters) return {};
  std::vector<Index> ordered(mesh.clusters->patches.size());
  parallelFor(mesh.clusters->size(), 1, [&](std::size_t c) {
    std::ranges::copy(originOrder(mesh, mesh.clusters->patchesOf(c)),
                      ordered.begin() + std::ptrdiff_t(mesh.clusters->begin[c]));
  });
  return ordered;
}

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

RayCaster::RayCaster(const PatchMesh& mesh, RayItems items)
    : mesh_(mesh),
      ordered_(orderedClusters(mesh)),
      items_(items),
      scene_(mesh),
      embree_(scene_, mesh),
      targets_(scene_, embree_, [this](std::uint32_t item) { return rayItem(item); }),
      kernels_(rayKernels()) {}

RayOrigins RayCaster::origins(std::size_t unknown) const {
  const auto alone = Index(unknown);
  std::span<const Index> patches(&alone, 1);
  if (mesh_.clusters) {
    patches = std::span(ordered_).subspan(mesh_.clusters->begin[unknown],
                                          mesh_.clusters->patchesOf(unknown).size());
  }
  return {mesh_, patches, scene_.scale, embree_.middle()};
}

bool RayCaster::canAim(const RayOrigins& origins) const {
  for (std::uint32_t k = 0; k < origins.parts(); ++k) {
    if (embree_.isNearPolygon(origins.part(k).polygon)) return false;
  }
  return true;
}

std::size_t RayCaster::bytes() const {
  // Embree's tree takes about this much a triangle in robust mode.
  constexpr std::size_t kTreeBytes = 160;
  return scene_.bytes() + targets_.bytes() + triangles() * kTreeBytes +
         ordered_.size() * sizeof(Index);
}

/// The item of rays for an item of the ViewScene.
std::uint32_t RayCaster::rayItem(std::uint32_t item) const {
  const std::size_t patches = scene_.patches;
  if (item < patches) return frontOf(item);
  return std::uint32_t(fronts() + (item - patches));
}

/// Calls visit(ray, item) with the ray's place in the batch; kSky stands for no item.
template <class Visit>
void RayCaster::tracePacket(const RayOrigins& origins, Batch& batch, const std::uint16_t* order,
                            int lanes, const Visit& visit) const {
  RTCRayHit16 packet;
  RayEnds ends;
  initPacket(packet);
  kernels_.fill(batch.arrays(origins), order, packet);
  embree_.trace(packet, lanes,
                origins.parts() < kManyParts ? Coherence::coherent : Coherence::incoherent);
  kernels_.find(packet, targets_, ends);
  for (int k = 0; k < lanes; ++k) {
    const std::size_t ray = order[k];
    const Index own = origins.part(std::uint32_t(batch.part[ray])).polygon;
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

/// Calls packet(batch, order, lanes) for packets of rays `first` to `last` of each replicate.
template <class Packet>
void RayCaster::forPackets(const RayOrigins& origins, std::uint64_t seed, std::uint32_t first,
                           std::uint32_t last, const Packet& packet) const {
  const FlushDenormals flush;
  const auto batch = std::make_unique_for_overwrite<Batch>();
  while (first < last) {
    batch->each = std::min<std::size_t>(last - first, kBatch / kReplicates);
    batch->place(sobol_, seed, first);
    batch->aim(origins, kernels_);
    batch->sort();
    for (std::size_t k = 0; k < batch->size(); k += kRayLanes) {
      const int lanes = int(std::min<std::size_t>(batch->size() - k, kRayLanes));
      packet(*batch, batch->order.data() + k, lanes);
    }
    first += std::uint32_t(batch->each);
  }
}

/// Calls visit(batch, ray, item) for rays `first` to `last` of each replicate.
template <class Visit>
void RayCaster::trace(const RayOrigins& origins, std::uint64_t seed, std::uint32_t first,
                      std::uint32_t last, const Visit& visit) const {
  forPackets(origins, seed, first, last, [&](Batch& batch, const std::uint16_t* order, int lanes) {
    tracePacket(origins, batch, order, lanes,
                [&](std::size_t ray, std::uint32_t item) { visit(batch, ray, item); });
  });
}

void RayCaster::cast(const RayOrigins& origins, std::uint64_t seed, std::uint32_t first,
                     std::uint32_t last, std::array<Counts, kReplicates>& of_replicate) const {
  if (origins.empty()) return;
  trace(origins, seed, first, last, [&](const Batch& batch, std::size_t ray, std::uint32_t item) {
    Counts& counts = of_replicate[ray < batch.each ? 0 : 1];
    if (item == kSky) {
      ++counts.sky;
    } else {
      counts.add(item, 1);
    }
  });
}

void RayCaster::visitEnd(const RayOrigins& origins, const Batch& batch, std::size_t ray,
                         std::uint32_t item, const EndVisitor& visit) const {
  visit(batch.from(ray), origins.frame(origins.part(std::uint32_t(batch.part[ray])).frame).z,
        item == kSky ? std::uint32_t(items()) : item);
}

void RayCaster::visitEnds(const RayOrigins& origins, std::uint64_t seed, std::uint32_t rays,
                          const EndVisitor& visit) const {
  Ends ends;
  visitEnds(origins, seed, rays, ends, visit);
}

void RayCaster::visitEnds(const RayOrigins& origins, std::uint64_t seed, std::uint32_t rays,
                          Ends& ends, const EndVisitor& visit) const {
  if (origins.empty()) return;
  if (ends.empty()) {
    ends.reserve(std::size_t(rays) * kReplicates);
    trace(origins, seed, 0, rays, [&](const Batch& batch, std::size_t ray, std::uint32_t item) {
      ends.push_back(item);
      visitEnd(origins, batch, ray, item, visit);
    });
    return;
  }
  std::size_t next = 0;
  forPackets(origins, seed, 0, rays,
             [&](const Batch& batch, const std::uint16_t* order, int lanes) {
               for (int k = 0; k < lanes; ++k) {
                 visitEnd(origins, batch, order[k], ends[next++], visit);
               }
             });
}

}  // namespace radiosity
