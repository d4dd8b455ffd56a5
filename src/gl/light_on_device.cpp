#include "gl/light_on_device.h"

#include <algorithm>
#include <initializer_list>
#include <span>
#include <vector>

#include "gl/shaders.h"

namespace radiosity::gl {

LightOnDevice::LightOnDevice(const GpuField& field, int resolution)
    : resolution_(resolution),
      bands_(field.bands),
      eyes_(field.eyes),
      patches_(field.patches),
      means_(field.first_of_mean.empty() ? 0 : field.first_of_mean.size() - 1),
      parts_a_view_(field.first_facet.empty()
                        ? 0
                        : 3 * std::size_t(resolution) * groups(std::size_t(resolution), 128)),
      means_of_{{GL_COMPUTE_SHADER, {kMeans}}},
      interpolate_{{GL_COMPUTE_SHADER, {kTypes, kPixels, kInterpolate}}},
      gather_{{GL_COMPUTE_SHADER, {kTypes, kGather}}} {
  const auto store = [](Buffer& buffer, const auto& values) { buffer.store(std::span(values)); };
  store(vertices_, field.vertices);
  store(facets_, field.facets);
  store(first_facet_, field.first_facet);
  store(mean_of_, field.mean_of);
  store(first_of_mean_, field.first_of_mean);
  std::vector<float> values = field.emission;
  values.insert(values.end(), field.reflectance.begin(), field.reflectance.end());
  values.insert(values.end(), field.sky.begin(), field.sky.end());
  store(materials_, values);
  values = field.emission;
  values.resize((eyes_ + means_) * bands_);
  store(radiosity_[0], values);
  store(radiosity_[1], values);
}

std::size_t LightOnDevice::largestBlock() const {
  std::size_t largest = 0;
  for (const Buffer* buffer : {&vertices_, &facets_, &first_facet_, &mean_of_, &first_of_mean_,
                               &materials_, &radiosity_[0]}) {
    largest = std::max(largest, buffer->bytes());
  }
  return largest;
}

void LightOnDevice::makeRoom(std::size_t views) {
  irradiance_.reserve(irradianceBytes(views));
  parts_.reserve(partBytes(views));
}

void LightOnDevice::takeMeans() {
  if (means_ == 0) return;
  means_of_.useWith({&mean_of_, &first_of_mean_, &radiosity_[now_]});
  glUniform1ui(means_of_.uniform("means"), std::uint32_t(means_));
  glUniform1ui(means_of_.uniform("eyes"), std::uint32_t(eyes_));
  glUniform1ui(means_of_.uniform("bands"), std::uint32_t(bands_));
  glDispatchCompute(groups(means_ * bands_, 64), 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void LightOnDevice::gather(const GatheredBatch& batch) {
  const auto patches = std::uint32_t(patches_);
  const Buffer& radiosity = radiosity_[now_];
  if (parts_a_view_ > 0) {
    interpolate_.useWith({&batch.top_sums, &batch.side_sums, &batch.views, &vertices_,
                          &first_facet_, &facets_, &radiosity, &parts_});
    glUniform1i(interpolate_.uniform("resolution"), resolution_);
    glUniform1i(interpolate_.uniform("tiles_across"), batch.tiles_across);
    glUniform1ui(interpolate_.uniform("patches"), patches);
    glUniform1ui(interpolate_.uniform("bands"), std::uint32_t(bands_));
    glDispatchCompute(groups(std::size_t(resolution_), 128), GLuint(3 * resolution_), batch.count);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  }
  gather_.useWith({&batch.low, &batch.high, &batch.views, &radiosity, &parts_, &materials_,
                   &irradiance_, &radiosity_[1 - now_]});
  glUniform1ui(gather_.uniform("patches"), patches);
  glUniform1ui(gather_.uniform("items"), batch.items);
  glUniform1ui(gather_.uniform("bands"), std::uint32_t(bands_));
  glUniform1ui(gather_.uniform("eyes"), std::uint32_t(eyes_));
  glUniform1ui(gather_.uniform("part_count"), std::uint32_t(parts_a_view_));
  glDispatchCompute(batch.count, 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
}

}  // namespace radiosity::gl
