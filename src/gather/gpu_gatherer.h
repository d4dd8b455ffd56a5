// Gathering by the GPU's eye.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "formfactor/hemicube/gpu_eye.h"
#include "gather/passes.h"

namespace radiosity {

/// Gathers at all eyes of a scene, pass by pass. The reflected light stays on the device for the
/// next pass. Results are those of Gatherer, to rounding.
class GpuGatherer {
 public:
  /// Keeps `scene` by reference. If the device has no room for its light, pass() says so.
  GpuGatherer(const GatherScene& scene, std::unique_ptr<GpuEye> eye);

  struct Seen {
    Gatherer::Received received;
    std::span<const double> backs;  ///< the share of the view on each surface's back
  };
  /// Calls take(eye, seen) on all threads for every eye that looks, and advances `progress`.
  /// Returns an empty text, or the reason why the device gave up: then some eyes were left out, and
  /// there are no further passes.
  std::string pass(const std::function<void(std::size_t, const Seen&)>& take, Progress& progress);

  const HemicubeReport& counts() const { return counts_; }
  const EyeDevice& device() const { return eye_->device(); }
  std::size_t bytes() const { return eye_->bytes(); }

 private:
  const GatherScene& scene_;
  std::unique_ptr<GpuEye> eye_;
  std::string problem_;         ///< why no pass is possible; empty: passes are possible
  std::vector<Index> looking_;  ///< eyes
  HemicubeReport counts_;
};

}  // namespace radiosity
