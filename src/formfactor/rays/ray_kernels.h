// The inner loops of rays beside Embree's: scrambling points, aiming rays, filling packets, finding
// what was hit. One kernel per instruction set, Highway's scalar target among them; all give the
// same bits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "formfactor/rays/embree_scene.h"
#include "formfactor/rays/ray_origins.h"
#include "formfactor/rays/ray_target.h"

namespace radiosity {

/// Cells along each of two dimensions that directions are sorted into.
inline constexpr std::uint32_t kDirectionCells = 32;

/// Rays of a batch, by dimension. All arrays have room for whole packets.
struct RayArrays {
  std::array<const float*, 4> points;  ///< of each part's own range; then of the directions' square
  const std::int32_t* part;            ///< from which each ray leaves; null: all from part 0
  std::array<float*, 3> origin;
  std::array<float*, 3> direction;
  std::uint16_t* cell;  ///< of the direction, below kDirectionCells^2, along a Z curve
};

struct RayKernels {
  std::string target;  ///< instruction set, by Highway's name
  /// out[k], in [0, 1): the bit-reversed digits first[k] ^ base, scrambled by `seed` and turned
  /// round again. `first` is read in whole vectors, up to a multiple of kRayLanes.
  void (*scramble)(const std::uint32_t* first, std::size_t count, std::uint32_t base,
                   std::uint32_t seed, float* out);
  /// Takes points of the unit square to the unit disc (P. Shirley, K. Chiu, "A low distortion map
  /// between disk and square", J. Graphics Tools 2(3), 1997), and so to cosine-distributed
  /// directions. All arrays have room for whole packets.
  void (*toDisc)(const float* x, const float* y, std::size_t count, float* u, float* v);
  /// Computes where rays leave, kRayLift before their part, and in which direction, and its cell:
  /// of the points where all parts lie in one plane, else of the direction itself, on an octahedron
  /// laid flat. In whole vectors.
  void (*aim)(const RayOrigins& from, std::size_t count, const RayArrays& rays);
  /// Puts rays order[0] to order[kRayLanes - 1] into a packet.
  void (*fill)(const RayArrays& rays, const std::uint16_t* order, RTCRayHit16& packet);
  /// What each lane that has a hit has hit; other lanes get any value.
  void (*find)(const RTCRayHit16& packet, const RayTargets& targets, RayEnds& ends);
};

/// The kernels for the best instruction set of this machine.
RayKernels rayKernels();

}  // namespace radiosity
