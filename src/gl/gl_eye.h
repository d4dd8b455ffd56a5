// The GPU eye on one device of OpenGL.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "formfactor/hemicube/face_geometry.h"
#include "formfactor/hemicube/gpu_eye.h"
#include "gl/device.h"
#include "gl/objects.h"

namespace radiosity::gl {

/// How many hemicubes are drawn at once, and what they take. The faces of one fill a tile of
/// 2 x 3/2 resolutions.
struct BatchPlan {
  std::uint32_t views = 0;
  std::uint32_t across = 0, down = 0;  ///< tiles of the target
  std::size_t triangles = 0;           ///< that there is room for after clipping
};

class GlEye final : public GpuEye {
 public:
  /// Failure where the device does not hold the scene and one hemicube.
  GlEye(const Device& device, const GpuScene& scene, const GpuWeights& weights);
  ~GlEye() override;
  GlEye(const GlEye&) = delete;
  GlEye& operator=(const GlEye&) = delete;

  std::string look(std::size_t count, const Describe& describe, const Take& take) override;
  std::string prepare(const GpuField& field) override;
  std::string gather(std::size_t count, const Describe& describe, const Take& take) override;
  std::vector<Index> pictures(const Describe& describe) override;
  std::size_t bytes() const override;
  const EyeDevice& device() const override { return about_; }

 private:
  struct OnDevice;
  struct Light;
  /// Hemicubes that the device works on: views [first, first + count).
  struct Batch {
    std::size_t first = 0;
    std::uint32_t count = 0;
    std::size_t slot = 0;  ///< of the ring
  };

  BatchPlan plan() const;
  void makeRoom();
  void describe(const Batch& batch, const Describe& describe);
  void draw(const Batch& batch);
  void sum(const Batch& batch);
  void gatherLight(const Batch& batch);
  void takeMeans();
  void send(const Batch& batch);
  void wait(const Batch& batch) const;
  bool hasOverflowed(const Batch& batch);
  GpuRows rowsOf(const Batch& batch) const;
  void lookAtAll(std::size_t count, const Describe& describe, const Take& take, bool gathers);
  std::size_t rowWeights(std::size_t views) const { return views * (std::size_t(items_) + 1); }
  /// Of irradiance in a slot of the ring.
  std::size_t irradianceBytes(std::size_t views) const;

  EyeDevice about_;
  Context context_;
  int resolution_;
  double coincidence_;
  std::uint32_t items_;
  std::uint32_t polygons_;
  std::uint32_t triangles_;
  std::uint32_t hidden_words_;                ///< a view
  std::size_t most_views_ = ~std::size_t(0);  ///< as far as rooms for triangles sufficed
  std::size_t triangle_room_ = 0;             ///< of a view
  BatchPlan plan_;
  std::unique_ptr<OnDevice> on_device_;
  std::unique_ptr<Light> light_;  ///< null: none is gathered
};

}  // namespace radiosity::gl
