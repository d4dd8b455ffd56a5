// The light that hemicubes gather, kept on the device.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "formfactor/hemicube/gpu_eye.h"
#include "gl/objects.h"

namespace radiosity::gl {

/// A batch of hemicubes: the picture, bound as image 0, has the item of every pixel.
struct GatheredBatch {
  const Buffer& top_sums;
  const Buffer& side_sums;
  const Buffer& views;
  const Buffer& low;  ///< halves of the rows
  const Buffer& high;
  std::uint32_t count;  ///< of views
  std::uint32_t items;
  int tiles_across;
};

/// A GpuField on the device: its radiosity, and the data that makes the next one from irradiance.
class LightOnDevice {
 public:
  LightOnDevice(const GpuField& field, int resolution);

  /// The bytes of the largest buffer whose size does not depend on the views.
  std::size_t largestBlock() const;
  std::size_t irradianceBytes(std::size_t views) const { return views * bands_ * sizeof(double); }
  /// The bytes of the sums of 128 pixels.
  std::size_t partBytes(std::size_t views) const { return parts_a_view_ * irradianceBytes(views); }
  void makeRoom(std::size_t views);

  /// Computes the means of the radiosity that is gathered.
  void takeMeans();
  void gather(const GatheredBatch& batch);
  /// Makes the next radiosity the one that is gathered.
  void takeNext() { now_ = 1 - now_; }

  const Buffer& irradiance() const { return irradiance_; }

 private:
  int resolution_;
  std::size_t bands_, eyes_, patches_, means_;
  std::size_t parts_a_view_;  ///< sums of 128 pixels; 0: patches have one radiosity
  Program means_of_;
  Program interpolate_;
  Program gather_;
  Buffer vertices_, facets_, first_facet_, mean_of_, first_of_mean_, materials_;
  std::array<Buffer, 2> radiosity_;  ///< the one that is gathered, and the next
  std::size_t now_ = 0;
  Buffer parts_, irradiance_;
};

}  // namespace radiosity::gl
