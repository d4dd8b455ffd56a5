// The buffers into which batches of hemicubes are drawn and from which they are read.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "formfactor/hemicube/face_geometry.h"
#include "gl/device.h"
#include "gl/objects.h"

namespace radiosity::gl {

/// The size of a corner that kClipTriangles writes.
inline constexpr std::size_t kCornerBytes = 20;

/// The number of hemicubes drawn at once and their room. The faces of one fill a tile of 2 x 3/2
/// resolutions.
struct BatchPlan {
  std::uint32_t views = 0;
  std::uint32_t across = 0, down = 0;  ///< tiles of the target
  std::size_t triangles = 0;           ///< the most triangles after clipping
};

class Texture {
 public:
  Texture(GLenum format, std::uint32_t width, std::uint32_t height) {
    glGenTextures(1, &name_);
    glBindTexture(GL_TEXTURE_2D, name_);
    glTexStorage2D(GL_TEXTURE_2D, 1, format, GLsizei(width), GLsizei(height));
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  }
  ~Texture() { glDeleteTextures(1, &name_); }
  Texture(const Texture&) = delete;
  Texture& operator=(const Texture&) = delete;
  GLuint name() const { return name_; }

 private:
  GLuint name_ = 0;
};

/// The framebuffer: polygons and depths of all tiles.
class Target {
 public:
  Target(std::uint32_t width, std::uint32_t height)
      : width_(width),
        height_(height),
        polygons_(GL_R32UI, width, height),
        depths_(GL_DEPTH_COMPONENT32F, width, height) {
    glGenFramebuffers(1, &name_);
    glBindFramebuffer(GL_FRAMEBUFFER, name_);
    glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, polygons_.name(), 0);
    glFramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, depths_.name(), 0);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
      throw Failure("the driver draws no 32-bit numbers with 32-bit depths");
    }
  }
  ~Target() { glDeleteFramebuffers(1, &name_); }
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;

  /// Sets all pixels to the sky, infinitely far.
  void clear() const {
    const std::array<GLuint, 4> sky = {kNone, 0, 0, 0};
    const GLfloat far = 0;
    glBindFramebuffer(GL_FRAMEBUFFER, name_);
    glClearBufferuiv(GL_COLOR, 0, sky.data());
    glClearBufferfv(GL_DEPTH, 0, &far);
  }

  /// Pixels.
  std::uint32_t width() const { return width_; }
  std::uint32_t height() const { return height_; }
  const Texture& polygons() const { return polygons_; }

 private:
  std::uint32_t width_, height_;
  Texture polygons_, depths_;
  GLuint name_ = 0;
};

/// Corners of triangles as they are drawn.
class CornerArray {
 public:
  explicit CornerArray(const Buffer& corners) {
    glGenVertexArrays(1, &name_);
    glBindVertexArray(name_);
    glBindVertexBuffer(0, corners.name(), 0, kCornerBytes);
    glEnableVertexAttribArray(0);
    glVertexAttribFormat(0, 4, GL_FLOAT, GL_FALSE, 0);
    glVertexAttribBinding(0, 0);
    glEnableVertexAttribArray(1);
    glVertexAttribIFormat(1, 1, GL_UNSIGNED_INT, 4 * sizeof(float));
    glVertexAttribBinding(1, 0);
  }
  ~CornerArray() { glDeleteVertexArrays(1, &name_); }
  CornerArray(const CornerArray&) = delete;
  CornerArray& operator=(const CornerArray&) = delete;
  void bind() const { glBindVertexArray(name_); }

 private:
  GLuint name_ = 0;
};

/// The input and output of one batch on the device.
struct Slot {
  explicit Slot(std::size_t bytes) : rows(bytes) {}
  Buffer views;
  Buffer hidden;
  MappedBuffer rows;  ///< irradiance, low halves, high halves, GpuCounts, DrawCall
  Fence done;
};

/// All buffers whose size depends on the batches.
struct Room {
  Room(const BatchPlan& plan, int resolution)
      : target(plan.across * 2 * std::uint32_t(resolution),
               plan.down * 3 * std::uint32_t(resolution) / 2),
        corner_array(corners) {}
  Target target;
  Buffer candidates;
  Buffer corners;
  CornerArray corner_array;
  Buffer low, high;
  std::vector<std::unique_ptr<Slot>> slots;
};

}  // namespace radiosity::gl
