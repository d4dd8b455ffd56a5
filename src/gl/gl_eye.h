// The GPU eye on one device of OpenGL.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "formfactor/hemicube/gpu_eye.h"
#include "gl/batch_room.h"
#include "gl/device.h"

namespace radiosity::gl {

class LightOnDevice;

/// The pace that suits a device.
const GpuPace& paceOf(const EyeDevice& device);

class GlEye final : public GpuEye {
 public:
  /// Throws Failure if the device cannot hold the scene and one hemicube.
  GlEye(const Device& device, const GpuScene& scene, const GpuWeights& weights,
        const GpuPace& pace);
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
  /// A batch of hemicubes on the device: views [first, first + count).
  struct Batch {
    std::size_t first = 0;
    std::uint32_t count = 0;
    std::size_t slot = 0;  ///< of the ring
  };

  void store(const GpuScene& scene, const GpuWeights& weights);
  std::size_t largestBlock() const;
  std::size_t largestBlockOfAView() const;
  std::size_t bytesOfAView() const;
  BatchPlan plan() const;
  void makeRoom();
  std::string onDevice(const std::function<void()>& work);
  void describe(const Batch& batch, const Describe& describe);
  void draw(const Batch& batch);
  void sum(const Batch& batch);
  void gatherLight(const Batch& batch);
  void send(const Batch& batch);
  void wait(const Batch& batch) const;
  bool hasOverflowed(const Batch& batch);
  GpuRows rowsOf(const Batch& batch) const;
  void lookAtAll(std::size_t count, const Describe& describe, const Take& take, bool gathers);
  std::size_t rowWeights(std::size_t views) const { return views * (std::size_t(items_) + 1); }
  /// The bytes of irradiance in a slot of the ring.
  std::size_t irradianceBytes(std::size_t views) const;
  /// The bytes of the sums of 128 pixels.
  std::size_t partBytes(std::size_t views) const;

  EyeDevice about_;
  GpuPace pace_;
  Context context_;
  int resolution_;
  double coincidence_;
  std::uint32_t items_;
  std::uint32_t polygons_;
  std::uint32_t triangles_;
  std::uint32_t hidden_words_;                ///< a view
  std::size_t most_views_ = ~std::size_t(0);  ///< lowered when triangles did not fit
  std::size_t triangle_room_ = 0;             ///< of a view
  BatchPlan plan_;
  std::unique_ptr<OnDevice> on_device_;
  std::unique_ptr<LightOnDevice> light_;  ///< null: no light is gathered
  std::string failure_;                   ///< why the device gave up; empty: it works
};

}  // namespace radiosity::gl
