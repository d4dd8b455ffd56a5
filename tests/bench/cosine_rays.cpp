#include "cosine_rays.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>

#include "base/parallel.h"

namespace radiosity::bench {
namespace {

constexpr int kLanes = 16;
/// Rays start this far in front of their patch, in scenes of size 1: a few roundings of single
/// precision, so that few hit their own polygon and next to none miss a wall that the patch
/// touches.
constexpr float kLift = 2e-7F;
/// Directions are sorted into this many cells along each of the two dimensions: kBlock points of a
/// net then put about one packet into each.
constexpr std::uint32_t kCells = 16;

/// cos and sin of angles up to pi / 4, to 1e-7.
float smallCos(float x) {
  const float y = x * x;
  return 1 + y * (-0.5F + y * (1.0F / 24 + y * (-1.0F / 720 + y * (1.0F / 40320))));
}
float smallSin(float x) {
  const float y = x * x;
  return x * (1 + y * (-1.0F / 6 + y * (1.0F / 120 + y * (-1.0F / 5040))));
}

/// Where a patch's rays start: triangles to choose from by area, or one parallelogram.
struct Origins {
  bool parallelogram;
  std::vector<std::array<glm::vec3, 3>> parts;  ///< a corner and the edges that leave it
  std::vector<float> share;                     ///< cumulative, of area

  Origins(const PatchMesh& mesh, std::size_t patch, double scale) : parallelogram(false) {
    const auto vertex = [&](Index v) { return mesh.vertices[v] * scale; };
    const auto outline = mesh.outline(patch);
    if (outline.size() == 4) {
      const Vec3 a = vertex(outline[0]);
      const Vec3 b = vertex(outline[1]);
      const Vec3 c = vertex(outline[2]);
      const Vec3 d = vertex(outline[3]);
      // To single precision, which is all the rays have.
      parallelogram = glm::length(a - b + c - d) <= 1e-7 * glm::length(c - a);
      if (parallelogram) {
        parts.push_back({glm::vec3(a), glm::vec3(b - a), glm::vec3(d - a)});
        share.push_back(1);
        return;
      }
    }
    double sum = 0;
    for (std::size_t t = mesh.piece_offset[patch]; t < mesh.piece_offset[patch + 1]; ++t) {
      const Vec3 a = vertex(mesh.pieces[t][0]);
      const Vec3 b = vertex(mesh.pieces[t][1]);
      const Vec3 c = vertex(mesh.pieces[t][2]);
      sum += glm::length(glm::cross(b - a, c - a));
      parts.push_back({glm::vec3(a), glm::vec3(b - a), glm::vec3(c - a)});
      share.push_back(float(sum));
    }
    for (float& s : share) s /= float(sum);
  }

  glm::vec3 at(float x, float y) const {
    if (parallelogram) return parts[0][0] + x * parts[0][1] + y * parts[0][2];
    std::size_t k = 0;
    while (k + 1 < share.size() && x >= share[k]) ++k;
    const float low = k == 0 ? 0 : share[k - 1];
    const float root = std::sqrt(std::max(0.0F, (x - low) / (share[k] - low)));
    return parts[k][0] + root * ((1 - y) * parts[k][1] + y * parts[k][2]);
  }
};

/// A point of the unit disc (Shirley and Chiu 1997, concentric), which keeps neighbours together.
void toDisc(float x, float y, float& u, float& v) {
  const float a = 2 * x - 1;
  const float b = 2 * y - 1;
  const bool wide = std::abs(a) > std::abs(b);
  const float radius = wide ? a : b;
  const float other = wide ? b : a;
  const float angle = radius == 0 ? 0 : 0.785398163F * (other / radius);
  const float along = radius * smallCos(angle);
  const float across = radius * smallSin(angle);
  u = wide ? along : across;
  v = wide ? across : along;
}

/// The order in which points leave together: by direction, 2-D cells along a Z curve.
void sortByDirection(const PointBlock& points, std::uint32_t count,
                     std::array<std::uint32_t, kBlock>& order) {
  std::array<std::uint32_t, kCells * kCells + 1> start{};
  std::array<std::uint8_t, kBlock> cell;
  for (std::uint32_t k = 0; k < count; ++k) {
    std::uint32_t x = std::uint32_t(points[2][k] * kCells);
    std::uint32_t y = std::uint32_t(points[3][k] * kCells);
    x = (x | (x << 2)) & 0x33u;
    y = (y | (y << 2)) & 0x33u;
    x = (x | (x << 1)) & 0x55u;
    y = (y | (y << 1)) & 0x55u;
    cell[k] = std::uint8_t(x | (y << 1));
    ++start[cell[k] + 1u];
  }
  for (std::size_t c = 1; c < start.size(); ++c) start[c] += start[c - 1];
  for (std::uint32_t k = 0; k < count; ++k) order[start[cell[k]]++] = k;
}

}  // namespace

struct CosineRays::Batch {
  PointBlock points;
  std::array<std::uint32_t, kBlock> order;
  std::array<std::array<float, kBlock>, 2> disc;
  std::array<std::array<float, kBlock>, 3> origin;
  std::array<std::array<float, kBlock>, 3> direction;
};

CosineRays::CosineRays(const PatchMesh& mesh) : mesh_(mesh), scene_(mesh), embree_(scene_) {
  polygon_place_.resize(mesh.polygons.size());
  for (std::uint32_t p = 0; p < scene_.polygons.size(); ++p) {
    polygon_place_[scene_.polygons[p].source] = p;
  }
  targets_.resize(embree_.triangles().size());
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    const ViewPolygon& polygon = scene_.polygons[embree_.polygonOf()[t]];
    const auto& corners = embree_.triangles()[t];
    const Vec3 a = scene_.vertices[corners[0]];
    const Vec3 ab = scene_.vertices[corners[1]] - a;
    const Vec3 ac = scene_.vertices[corners[2]] - a;
    for (std::size_t side = 0; side < 2; ++side) {
      Target& target = targets_[t][side];
      target.item = polygon.side[side].item;
      if (polygon.side[side].grid == kNone) continue;
      const PatchGrid& grid = scene_.grids[polygon.side[side].grid];
      const Vec3 from = a - polygon.origin;
      target.grid = &grid;
      target.u = {float(glm::dot(grid.uAxis(), from) + grid.uOffset()),
                  float(glm::dot(grid.uAxis(), ab)), float(glm::dot(grid.uAxis(), ac))};
      target.v = {float(glm::dot(grid.vAxis(), from) + grid.vOffset()),
                  float(glm::dot(grid.vAxis(), ab)), float(glm::dot(grid.vAxis(), ac))};
    }
  }
}

std::uint32_t CosineRays::Target::itemAt(float s, float t) const {
  if (grid == nullptr) return item;
  const float gu = u[0] + s * u[1] + t * u[2];
  const float gv = v[0] + s * v[1] + t * v[2];
  // Cells are centred on whole numbers.
  const auto column = std::clamp(std::int32_t(gu + 0.5F), 0, grid->columns() - 1);
  const auto row = std::clamp(std::int32_t(gv + 0.5F), 0, grid->rows() - 1);
  std::int32_t entry = grid->cells()[std::size_t(row * grid->columns() + column)];
  while (entry < 0) {
    const CellNode& node = grid->node(~entry);
    entry = node.a * gu + node.b * gv + node.c >= 0 ? node.inside : node.outside;
  }
  return std::uint32_t(entry);
}

void CosineRays::fillBatch(std::size_t patch, std::size_t count, Batch& batch) const {
  const Origins origins(mesh_, patch, scene_.scale);
  const glm::vec3 lift = kLift * glm::vec3(mesh_.normal[patch]);
  const auto& points = batch.points;
  for (std::size_t k = 0; k < count; ++k) {
    const glm::vec3 from = origins.at(points[0][k], points[1][k]) + lift;
    for (std::size_t c = 0; c < 3; ++c) batch.origin[c][k] = from[int(c)];
  }
  for (std::size_t k = 0; k < count; ++k) {
    toDisc(points[2][k], points[3][k], batch.disc[0][k], batch.disc[1][k]);
  }
  const Vec3 normal = mesh_.normal[patch];
  const Vec3 helper = std::abs(normal.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  const Vec3 across = glm::normalize(glm::cross(helper, normal));
  const glm::vec3 x(across);
  const glm::vec3 y(glm::cross(normal, across));
  const glm::vec3 z(normal);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < count; ++k) {
      const float u = batch.disc[0][k];
      const float v = batch.disc[1][k];
      const float w = std::sqrt(std::max(0.0F, 1 - u * u - v * v));
      batch.direction[c][k] = u * x[int(c)] + v * y[int(c)] + w * z[int(c)];
    }
  }
}

void CosineRays::tracePacket(const Batch& batch, const std::uint32_t* order,
                             std::uint32_t own_polygon, int lanes, Row& row) const {
  alignas(64) std::array<int, kLanes> valid;
  RTCRayHit16 packet;
  for (int k = 0; k < kLanes; ++k) {
    valid[std::size_t(k)] = k < lanes ? -1 : 0;
    const std::uint32_t from = order[k < lanes ? k : 0];
    packet.ray.org_x[k] = batch.origin[0][from];
    packet.ray.org_y[k] = batch.origin[1][from];
    packet.ray.org_z[k] = batch.origin[2][from];
    packet.ray.dir_x[k] = batch.direction[0][from];
    packet.ray.dir_y[k] = batch.direction[1][from];
    packet.ray.dir_z[k] = batch.direction[2][from];
    packet.ray.tnear[k] = 0;
    packet.ray.tfar[k] = std::numeric_limits<float>::infinity();
    packet.ray.time[k] = 0;
    packet.ray.mask[k] = 0xffffffffu;
    packet.ray.flags[k] = 0;
    packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid.data(), embree_.handle(), &context, &packet);
  for (int k = 0; k < lanes; ++k) {
    if (packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) {
      ++row.sky;
      continue;
    }
    const std::uint32_t triangle = packet.hit.primID[k];
    if (embree_.polygonOf()[triangle] == own_polygon) {
      ++row.own;
      continue;
    }
    // A triangle's corners run counter-clockwise about the front, and Embree's normal is
    // (v1 - v0) x (v2 - v0).
    const bool front = packet.hit.Ng_x[k] * packet.ray.dir_x[k] +
                           packet.hit.Ng_y[k] * packet.ray.dir_y[k] +
                           packet.hit.Ng_z[k] * packet.ray.dir_z[k] <
                       0;
    ++row.hits[targets_[triangle][front ? 0 : 1].itemAt(packet.hit.u[k], packet.hit.v[k])];
  }
}

void CosineRays::cast(std::size_t patch, std::uint32_t rays, Row& row) const {
  row.hits.assign(scene_.items, 0);
  row.sky = 0;
  row.own = 0;
  if (mesh_.polygon[patch] == kNone || !(mesh_.area[patch] > 0)) return;
  const FlushDenormals flush;
  const std::uint32_t own = polygon_place_[mesh_.polygon[patch]];
  const auto batch = std::make_unique<Batch>();
  for (std::uint32_t done = 0; done < rays; done += kBlock) {
    const std::uint32_t count = std::min<std::uint32_t>(rays - done, kBlock);
    sobol_.block(done / kBlock, count, patch, batch->points);
    fillBatch(patch, count, *batch);
    sortByDirection(batch->points, count, batch->order);
    for (std::uint32_t k = 0; k < count; k += kLanes) {
      const int lanes = int(std::min<std::uint32_t>(count - k, kLanes));
      tracePacket(*batch, batch->order.data() + k, own, lanes, row);
    }
  }
}

}  // namespace radiosity::bench
