#include "formfactor/rays/ray_caster.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/parallel.h"
#include "formfactor/rays/disc.h"

namespace radiosity {
namespace {

/// Ends of a ray that are no items.
constexpr std::uint32_t kSky = kNone - 1;
constexpr std::uint32_t kLost = kNone - 2;
/// Rays that are sorted together, at most: their batch fits the second-level cache.
constexpr std::size_t kBatch = 16384;
/// Directions are sorted into this many cells along each of two dimensions: kBatch points then put
/// about one packet into each.
constexpr std::uint32_t kCells = 32;

/// The bits of a number below kCells with a 0 before each.
std::uint32_t spread(std::uint32_t x) {
  x = (x | (x << 4)) & 0x10fu;
  x = (x | (x << 2)) & 0x133u;
  return (x | (x << 1)) & 0x155u;
}

/// The place of cell (x, y), each below kCells, along a Z curve.
std::uint16_t zCurve(std::uint32_t x, std::uint32_t y) {
  return std::uint16_t(spread(x) | (spread(y) << 1));
}

std::uint32_t cellOf(float x) { return std::min(std::uint32_t(x * float(kCells)), kCells - 1); }

/// The cell of a unit direction on an octahedron laid flat (Cigolle et al., JCGT 3(2), 2014).
std::uint16_t octahedralCell(float x, float y, float z) {
  const float scale = 1 / (std::abs(x) + std::abs(y) + std::abs(z));
  float u = x * scale;
  float v = y * scale;
  if (z < 0) {
    const float folded = (1 - std::abs(v)) * (u < 0 ? -1.0F : 1.0F);
    v = (1 - std::abs(u)) * (v < 0 ? -1.0F : 1.0F);
    u = folded;
  }
  return zCurve(cellOf(std::max(0.0F, 0.5F + 0.5F * u)), cellOf(std::max(0.0F, 0.5F + 0.5F * v)));
}

}  // namespace

/// Rays that are sorted together: those of all replicates, one replicate after the other.
struct RayCaster::Batch {
  std::size_t each = 0;  ///< rays of a replicate
  std::array<std::array<float, kBatch>, kDimensions> points;
  std::array<std::array<float, kBatch>, 2> disc;
  std::array<std::array<float, kBatch>, 3> origin;
  std::array<std::array<float, kBatch>, 3> direction;
  std::array<Index, kBatch> polygon;  ///< from which each ray leaves
  std::array<std::uint32_t, kBatch> frame;
  std::array<std::uint16_t, kBatch> cell;
  std::array<std::uint16_t, kBatch> order;

  std::size_t size() const { return kReplicates * each; }

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
  }

  void aim(const RayOrigins& origins) {
    for (std::size_t k = 0; k < size(); ++k) {
      toDisc(points[2][k], points[3][k], disc[0][k], disc[1][k]);
    }
    const bool planar = origins.isPlanar();
    for (std::size_t k = 0; k < size(); ++k) {
      float x = 0;
      const RayOrigins::Part& part = origins.part(origins.partAt(points[0][k], x));
      const RayFrame& axes = origins.frame(part.frame);
      const glm::vec3 from = RayOrigins::pointAt(part, x, points[1][k]) + kRayLift * axes.z;
      const float u = disc[0][k];
      const float v = disc[1][k];
      const float w = std::sqrt(std::max(0.0F, 1 - u * u - v * v));
      const glm::vec3 along = u * axes.x + v * axes.y + w * axes.z;
      for (std::size_t c = 0; c < 3; ++c) {
        origin[c][k] = from[int(c)];
        direction[c][k] = along[int(c)];
      }
      polygon[k] = part.polygon;
      frame[k] = part.frame;
      cell[k] = planar ? zCurve(cellOf(points[2][k]), cellOf(points[3][k]))
                       : octahedralCell(along.x, along.y, along.z);
    }
  }

  /// The order in which rays leave together: by direction.
  void sort() {
    std::array<std::uint16_t, kCells * kCells + 1> start{};
    for (std::size_t k = 0; k < size(); ++k) ++start[cell[k] + 1u];
    for (std::size_t c = 1; c < start.size(); ++c) {
      start[c] = std::uint16_t(start[c] + start[c - 1]);
    }
    for (std::size_t k = 0; k < size(); ++k) order[start[cell[k]]++] = std::uint16_t(k);
  }
};

RayCaster::RayCaster(const PatchMesh& mesh, RayItems items)
    : mesh_(mesh), items_(items), scene_(mesh), embree_(scene_, mesh) {
  setTargets();
}

std::size_t RayCaster::bytes() const {
  // Embree's tree takes about this much a triangle in robust mode.
  constexpr std::size_t kTreeBytes = 160;
  return scene_.bytes() + targets_.size() * (sizeof(targets_[0]) + sizeof(Index) + kTreeBytes);
}

/// The item of rays for an item of the ViewScene.
std::uint32_t RayCaster::rayItem(std::uint32_t item) const {
  const std::size_t patches = scene_.patches;
  if (item < patches) return frontOf(item);
  return std::uint32_t(fronts() + (item - patches));
}

void RayCaster::setTargets() {
  // If all patches of a side count for one item, there is nothing to look up.
  std::vector<std::array<std::uint32_t, 2>> only(mesh_.polygons.size(), {kNone, kNone});
  std::vector<std::array<std::uint8_t, 2>> several(mesh_.polygons.size(), {0, 0});
  for (std::size_t i = 0; i < mesh_.size(); ++i) {
    if (mesh_.polygon[i] == kNone) continue;
    const std::size_t side = mesh_.side[i] != 0;
    std::uint32_t& front = only[mesh_.polygon[i]][side];
    const std::uint32_t own = frontOf(i);
    several[mesh_.polygon[i]][side] |= std::uint8_t(front != kNone && front != own);
    front = own;
  }
  targets_.resize(embree_.triangles().size());
  source_.resize(targets_.size());
  parallelFor(targets_.size(), 1024, [&](std::size_t t) {
    const ViewPolygon& polygon = scene_.polygons[embree_.polygonOf()[t]];
    source_[t] = polygon.source;
    for (std::size_t side = 0; side < 2; ++side) {
      RayTarget& target = targets_[t][side];
      target.item = rayItem(polygon.side[side].item);
      if (several[polygon.source][side] == 0) continue;
      target.place(scene_.grids[polygon.side[side].grid], embree_, t, polygon.origin);
    }
  });
}

std::uint32_t RayCaster::itemAt(const RayTarget& target, float s, float t) const {
  return target.grid == nullptr ? target.item : rayItem(target.itemAt(s, t));
}

/// The item that the ray in lane k has hit.
std::uint32_t RayCaster::itemOf(const RTCRayHit16& packet, int k) const {
  // A triangle's corners run counter-clockwise about the front, and Embree's normal is
  // (v1 - v0) x (v2 - v0).
  const float along = packet.hit.Ng_x[k] * packet.ray.dir_x[k] +
                      packet.hit.Ng_y[k] * packet.ray.dir_y[k] +
                      packet.hit.Ng_z[k] * packet.ray.dir_z[k];
  const RayTarget& target = targets_[packet.hit.primID[k]][along < 0 ? 0 : 1];
  return itemAt(target, packet.hit.u[k], packet.hit.v[k]);
}

/// The item whose front covers the back that a ray has hit (EmbreeScene::frontAt()), or kNone.
std::uint32_t RayCaster::frontAt(const RTCRayHit16& packet, int k) const {
  const RTCHit front = embree_.frontAt(packet, k);
  if (front.geomID == RTC_INVALID_GEOMETRY_ID) return kNone;
  return itemAt(targets_[front.primID][0], front.u, front.v);
}

/// Calls visit(ray, item) with the ray's place in the batch; kSky and kLost stand for no item.
template <class Visit>
void RayCaster::tracePacket(const Batch& batch, const std::uint16_t* order, int lanes,
                            const Visit& visit) const {
  RTCRayHit16 packet;
  for (int k = 0; k < kRayLanes; ++k) {
    const std::size_t from = order[k < lanes ? k : 0];
    setRay(packet, k, {batch.origin[0][from], batch.origin[1][from], batch.origin[2][from]},
           {batch.direction[0][from], batch.direction[1][from], batch.direction[2][from]});
  }
  embree_.trace(packet, lanes);
  for (int k = 0; k < lanes; ++k) {
    if (packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) {
      visit(order[k], kSky);
      continue;
    }
    const std::uint32_t triangle = packet.hit.primID[k];
    if (source_[triangle] == batch.polygon[order[k]]) {
      visit(order[k], kLost);
      continue;
    }
    std::uint32_t item = itemOf(packet, k);
    if (item >= fronts()) {
      const std::uint32_t front = frontAt(packet, k);
      if (front != kNone) item = front;
    }
    visit(order[k], item);
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
    batch->aim(origins);
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
  forPackets(origins, seed, first, last,
             [&](const Batch& batch, const std::uint16_t* order, int lanes) {
               tracePacket(batch, order, lanes,
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
    } else if (item == kLost) {
      ++counts.own;
    } else {
      counts.add(item, 1);
    }
  });
}

void RayCaster::visitEnd(const RayOrigins& origins, const Batch& batch, std::size_t ray,
                         std::uint32_t item, const EndVisitor& visit) const {
  if (item == kLost) return;
  const glm::vec3 from(batch.origin[0][ray], batch.origin[1][ray], batch.origin[2][ray]);
  visit(from, origins.frame(batch.frame[ray]).z, item == kSky ? std::uint32_t(items()) : item);
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
