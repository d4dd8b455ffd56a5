#include "gl/gl_eye.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <deque>

#include "gl/light_on_device.h"
#include "gl/shaders.h"

namespace radiosity::gl {

namespace {

constexpr GpuPace kHardware{3, std::size_t(1) << 24};
/// In software larger batches gain nothing, and an interrupt waits for a whole batch.
constexpr GpuPace kSoftware{1, std::size_t(1) << 16};

/// Bytes of a batch; one hemicube may take more.
constexpr std::size_t kBatchBytes = std::size_t(256) << 20;
constexpr std::size_t kMostSide = std::size_t(1) << 15;  // of the target, pixels
constexpr std::size_t kMostViews = 4096;  // a dispatch may have at least 65,535 groups
/// The most triangles that clipping makes of one: four planes leave seven corners, that is five
/// triangles, on each of the five faces of a hemicube.
constexpr std::size_t kMostPieces = 25;
/// The room for clipped triangles at first, a triangle: most are seen on one face or none.
constexpr std::size_t kPieces = 1;
constexpr std::size_t kLittleRoom = 256;

constexpr std::size_t kCandidateBytes = 64;
constexpr std::size_t kPixelBytes = 8;

std::size_t pixelsOf(int resolution) {
  return 3 * std::size_t(resolution) * std::size_t(resolution);
}

std::size_t limitOf(GLenum name) {
  GLint64 limit = 0;
  glGetInteger64v(name, &limit);
  return std::size_t(limit);
}

/// The same layout as in kClipTriangles.
struct DrawCall {
  std::uint32_t count, instances, first, base_instance, needed;
};

}  // namespace

struct GlEye::OnDevice {
  Program find_candidates{{GL_COMPUTE_SHADER, {kTypes, kFindCandidates}}};
  Program clip_triangles{{GL_COMPUTE_SHADER, {kTypes, kClipTriangles}}};
  Program draw_triangles{{GL_VERTEX_SHADER, {kDrawCorner}},
                         {GL_FRAGMENT_SHADER, {kTypes, kDrawPixel}}};
  Program sum_rows{{GL_COMPUTE_SHADER, {kTypes, kPixels, kSumRows}}};
  Buffer vertices, corners, polygons, triangles, grids, cells, nodes, top_sums, side_sums;
  Buffer counts, draw_call;
  std::unique_ptr<Room> room;
};

const GpuPace& paceOf(const EyeDevice& device) { return device.hardware ? kHardware : kSoftware; }

GlEye::GlEye(const Device& device, const GpuScene& scene, const GpuWeights& weights,
             const GpuPace& pace)
    : about_(device.about),
      pace_(pace),
      context_(device.display),
      resolution_(weights.resolution),
      coincidence_(scene.coincidence),
      items_(scene.items),
      polygons_(std::uint32_t(scene.polygons.size())),
      triangles_(std::uint32_t(scene.triangles.size())),
      hidden_words_((polygons_ + 31) / 32),
      triangle_room_(std::min(kMostPieces * triangles_, kPieces * triangles_ + kLittleRoom)) {
  const Context::Current current(context_);
  try {
    store(scene, weights);
    makeRoom();
  } catch (...) {
    on_device_.reset();  // needs a current context
    throw;
  }
}

GlEye::~GlEye() {
  try {
    const Context::Current current(context_);
    light_.reset();
    on_device_.reset();
  } catch (const Failure&) {
    // The context is lost together with its objects, so there is nothing to delete.
    static_cast<void>(light_.release());
    static_cast<void>(on_device_.release());
  }
}

void GlEye::store(const GpuScene& scene, const GpuWeights& weights) {
  on_device_ = std::make_unique<OnDevice>();
  OnDevice& on = *on_device_;
  const auto store = [](Buffer& buffer, const auto& values) { buffer.store(std::span(values)); };
  store(on.vertices, scene.vertices);
  store(on.corners, scene.corners);
  store(on.polygons, scene.polygons);
  store(on.triangles, scene.triangles);
  store(on.grids, scene.grids);
  store(on.cells, scene.cells);
  store(on.nodes, scene.nodes);
  store(on.top_sums, weights.top);
  store(on.side_sums, weights.side);
  on.counts.reserve(sizeof(GpuCounts));
  on.draw_call.reserve(sizeof(DrawCall));
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_DEPTH_CLAMP);
  glDepthFunc(GL_GREATER);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
}

/// The bytes of the largest buffer of the shaders whose size does not depend on the views.
std::size_t GlEye::largestBlock() const {
  const OnDevice& on = *on_device_;
  std::size_t largest = 0;
  for (const Buffer* buffer : {&on.vertices, &on.corners, &on.polygons, &on.triangles, &on.grids,
                               &on.cells, &on.nodes, &on.top_sums, &on.side_sums}) {
    largest = std::max(largest, buffer->bytes());
  }
  if (light_ != nullptr) largest = std::max(largest, light_->largestBlock());
  return largest;
}

/// The most bytes that a view adds to one buffer.
std::size_t GlEye::largestBlockOfAView() const {
  return std::max({4 * rowWeights(1), kCandidateBytes * polygons_,
                   3 * kCornerBytes * triangle_room_, sizeof(GpuView),
                   4 * std::size_t(hidden_words_), irradianceBytes(1), partBytes(1)});
}

/// The bytes that a view adds to all buffers together.
std::size_t GlEye::bytesOfAView() const {
  const std::size_t row = 8 * rowWeights(1) + irradianceBytes(1);
  return pixelsOf(resolution_) * kPixelBytes + kCandidateBytes * polygons_ +
         3 * kCornerBytes * triangle_room_ + partBytes(1) + row * (1 + pace_.ring);
}

BatchPlan GlEye::plan() const {
  // A power of two: rounding the viewport up to one then stays within the device's limit.
  const std::size_t side = std::bit_floor(std::min(limitOf(GL_MAX_TEXTURE_SIZE), kMostSide));
  const std::size_t across = side / (2 * std::size_t(resolution_));
  const std::size_t down = side / (3 * std::size_t(resolution_) / 2);
  const std::size_t block = limitOf(GL_MAX_SHADER_STORAGE_BLOCK_SIZE);
  const std::size_t view = largestBlockOfAView();
  if (across == 0 || down == 0 || view > block || largestBlock() > block) {
    throw Failure("the scene is too large for the buffers of the device");
  }
  const std::size_t most =
      std::min({across * down, block / view, kBatchBytes / bytesOfAView(),
                pace_.pixels / pixelsOf(resolution_), kMostViews, most_views_});
  BatchPlan plan;
  plan.views = std::uint32_t(std::max<std::size_t>(most, 1));
  plan.across = std::uint32_t(std::min<std::size_t>(across, plan.views));
  plan.down = groups(plan.views, plan.across);
  plan.triangles = triangle_room_ * plan.views;
  return plan;
}

/// Makes room for batches as large as the plan allows. Throws Failure if the device has no room for
/// one hemicube.
void GlEye::makeRoom() {
  plan_ = plan();
  OnDevice& on = *on_device_;
  on.room.reset();
  on.room = std::make_unique<Room>(plan_, resolution_);
  Room& room = *on.room;
  const std::size_t rows = rowWeights(plan_.views) * 4;
  room.candidates.reserve(kCandidateBytes * polygons_ * plan_.views);
  room.corners.reserve(3 * kCornerBytes * plan_.triangles);
  room.low.reserve(rows);
  room.high.reserve(rows);
  if (light_ != nullptr) light_->makeRoom(plan_.views);
  for (std::size_t k = 0; k < pace_.ring; ++k) {
    room.slots.push_back(std::make_unique<Slot>(irradianceBytes(plan_.views) + 2 * rows +
                                                sizeof(GpuCounts) + sizeof(DrawCall)));
    Slot& slot = *room.slots.back();
    slot.views.reserve(sizeof(GpuView) * plan_.views, GL_STREAM_DRAW);
    slot.hidden.reserve(4 * std::size_t(hidden_words_) * plan_.views, GL_STREAM_DRAW);
    check("making room for hemicubes");
    if (slot.rows.data() == nullptr) throw Failure("the driver maps no memory");
  }
}

std::size_t GlEye::irradianceBytes(std::size_t views) const {
  return light_ == nullptr ? 0 : light_->irradianceBytes(views);
}

std::size_t GlEye::partBytes(std::size_t views) const {
  return light_ == nullptr ? 0 : light_->partBytes(views);
}

std::size_t GlEye::bytes() const {
  return bytesOfAView() * plan_.views + on_device_->top_sums.bytes() +
         on_device_->side_sums.bytes() + on_device_->cells.bytes();
}

void GlEye::describe(const Batch& batch, const Describe& describe) {
  std::vector<GpuView> views(batch.count);
  std::vector<std::uint32_t> hidden(std::size_t(batch.count) * hidden_words_, 0);
  for (std::size_t k = 0; k < batch.count; ++k) {
    describe(batch.first + k, views[k],
             std::span(hidden).subspan(k * hidden_words_, hidden_words_));
  }
  Slot& slot = *on_device_->room->slots[batch.slot];
  slot.views.write(std::span<const GpuView>(views));
  slot.hidden.write(std::span<const std::uint32_t>(hidden));
}

void GlEye::draw(const Batch& batch) {
  OnDevice& on = *on_device_;
  Room& room = *on.room;
  Slot& slot = *room.slots[batch.slot];
  on.counts.clear();
  const DrawCall none = {0, 1, 0, 0, 0};
  on.draw_call.write(std::span(&none, 1));

  on.find_candidates.useWith({&on.vertices, &on.corners, &on.polygons, &on.grids, &slot.views,
                              &slot.hidden, &room.candidates, &on.counts});
  glUniform1ui(on.find_candidates.uniform("polygon_count"), polygons_);
  glUniform1ui(on.find_candidates.uniform("hidden_words"), hidden_words_);
  glUniform1d(on.find_candidates.uniform("coincidence"), coincidence_);
  glDispatchCompute(groups(polygons_, 64), batch.count, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);

  on.clip_triangles.useWith(
      {&on.vertices, &on.triangles, &slot.views, &room.candidates, &room.corners, &on.draw_call});
  glUniform1ui(on.clip_triangles.uniform("triangle_count"), triangles_);
  glUniform1ui(on.clip_triangles.uniform("polygon_count"), polygons_);
  glUniform1ui(on.clip_triangles.uniform("capacity"), std::uint32_t(3 * plan_.triangles));
  glUniform1i(on.clip_triangles.uniform("resolution"), resolution_);
  glUniform1i(on.clip_triangles.uniform("tiles_across"), int(plan_.across));
  glDispatchCompute(kFaces, batch.count, 1);
  glMemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_COMMAND_BARRIER_BIT |
                  GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);

  room.target.clear();
  // With powers of two the viewport transform of corners is exact.
  const std::uint32_t width = std::bit_ceil(room.target.width());
  const std::uint32_t height = std::bit_ceil(room.target.height());
  glViewport(0, 0, GLsizei(width), GLsizei(height));
  on.draw_triangles.useWith({&room.candidates});
  glUniform1ui(on.draw_triangles.uniform("polygon_count"), polygons_);
  glUniform1i(on.draw_triangles.uniform("resolution"), resolution_);
  glUniform1i(on.draw_triangles.uniform("tiles_across"), int(plan_.across));
  glUniform2f(on.draw_triangles.uniform("scale"), 2 / float(width), 2 / float(height));
  room.corner_array.bind();
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, on.draw_call.name());
  glDrawArraysIndirect(GL_TRIANGLES, nullptr);
}

void GlEye::sum(const Batch& batch) {
  OnDevice& on = *on_device_;
  Room& room = *on.room;
  room.low.clear();
  room.high.clear();
  glBindImageTexture(0, room.target.polygons().name(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32UI);
  on.sum_rows.useWith({&room.candidates, &on.grids, &on.cells, &on.nodes, &on.top_sums,
                       &on.side_sums, &room.low, &room.high});
  glUniform1ui(on.sum_rows.uniform("polygon_count"), polygons_);
  glUniform1i(on.sum_rows.uniform("sky"), int(items_));
  glUniform1i(on.sum_rows.uniform("resolution"), resolution_);
  glUniform1i(on.sum_rows.uniform("tiles_across"), int(plan_.across));
  glUniform1i(on.sum_rows.uniform("keep_items"), light_ != nullptr);
  glDispatchCompute(groups(std::size_t(resolution_), 128), GLuint(3 * resolution_), batch.count);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                  GL_FRAMEBUFFER_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

/// Gathers light. Call it after sum(), which leaves items in the picture.
void GlEye::gatherLight(const Batch& batch) {
  const OnDevice& on = *on_device_;
  const Room& room = *on.room;
  light_->gather({on.top_sums, on.side_sums, room.slots[batch.slot]->views, room.low, room.high,
                  batch.count, items_, int(plan_.across)});
}

void GlEye::send(const Batch& batch) {
  const OnDevice& on = *on_device_;
  Slot& slot = *on.room->slots[batch.slot];
  const std::size_t half = 4 * rowWeights(batch.count);
  std::size_t at = irradianceBytes(batch.count);
  if (at > 0) slot.rows.copy(light_->irradiance(), 0, at);
  slot.rows.copy(on.room->low, at, half);
  slot.rows.copy(on.room->high, at + half, half);
  at += 2 * half;
  slot.rows.copy(on.counts, at, sizeof(GpuCounts));
  slot.rows.copy(on.draw_call, at + sizeof(GpuCounts), sizeof(DrawCall));
  glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
  slot.done.set();
}

void GlEye::wait(const Batch& batch) const {
  const Slot& slot = *on_device_->room->slots[batch.slot];
  while (!slot.done.wait()) check("drawing hemicubes");
}

GpuRows GlEye::rowsOf(const Batch& batch) const {
  const std::size_t values = rowWeights(batch.count);
  const std::size_t light = irradianceBytes(batch.count);
  const std::byte* data = on_device_->room->slots[batch.slot]->rows.data();
  const auto* irradiance = reinterpret_cast<const double*>(data);
  data += light;
  const auto* halves = reinterpret_cast<const std::uint32_t*>(data);
  GpuRows rows{batch.first,
               batch.count,
               {halves, values},
               {halves + values, values},
               {},
               {irradiance, light / sizeof(double)}};
  std::memcpy(&rows.counts, data + 8 * values, sizeof rows.counts);
  return rows;
}

/// Whether the clipped triangles did not fit. The next batches are then smaller or have more room.
bool GlEye::hasOverflowed(const Batch& batch) {
  DrawCall made{};
  const std::size_t at =
      irradianceBytes(batch.count) + 8 * rowWeights(batch.count) + sizeof(GpuCounts);
  std::memcpy(&made, on_device_->room->slots[batch.slot]->rows.data() + at, sizeof made);
  if (made.needed <= 3 * plan_.triangles) return false;
  if (batch.count > 1) {
    most_views_ = batch.count / 2;
    // Half of the views get twice the room each.
    triangle_room_ = std::min(kMostPieces * triangles_, 2 * triangle_room_);
  } else {
    triangle_room_ = std::min(kMostPieces * triangles_, std::size_t(made.needed) / 3);
  }
  return true;
}

void GlEye::lookAtAll(std::size_t count, const Describe& describe_view, const Take& take,
                      bool gathers) {
  std::deque<Batch> under_way;
  std::size_t next = 0;
  std::size_t made = 0;
  bool wanted = true;
  while (wanted && (next < count || !under_way.empty())) {
    while (next < count && under_way.size() < pace_.ring) {
      const Batch batch{next, std::uint32_t(std::min<std::size_t>(plan_.views, count - next)),
                        made++ % pace_.ring};
      describe(batch, describe_view);
      draw(batch);
      sum(batch);
      if (gathers) gatherLight(batch);
      send(batch);
      check("drawing hemicubes");
      under_way.push_back(batch);
      next += batch.count;
    }
    const Batch oldest = under_way.front();
    under_way.pop_front();
    wait(oldest);
    if (hasOverflowed(oldest)) {
      glFinish();
      under_way.clear();
      makeRoom();
      next = oldest.first;
      continue;
    }
    wanted = take(rowsOf(oldest));
  }
  glFinish();
}

/// Does `work` with the context current. Returns an empty text, or the reason why the device gave
/// up, now or before.
std::string GlEye::onDevice(const std::function<void()>& work) {
  if (!failure_.empty()) return failure_;
  try {
    const Context::Current current(context_);
    work();
  } catch (const Failure& failure) {
    failure_ = failure.what();
  }
  return failure_;
}

std::string GlEye::look(std::size_t count, const Describe& describe, const Take& take) {
  return onDevice([&] { lookAtAll(count, describe, take, false); });
}

std::string GlEye::prepare(const GpuField& field) {
  return onDevice([&] {
    light_ = std::make_unique<LightOnDevice>(field, resolution_);
    makeRoom();
  });
}

std::string GlEye::gather(std::size_t count, const Describe& describe, const Take& take) {
  return onDevice([&] {
    light_->takeMeans();
    lookAtAll(count, describe, take, true);
    light_->takeNext();
  });
}

std::vector<Index> GlEye::pictures(const Describe& describe_view) {
  const int width = 2 * resolution_;
  const int height = 3 * resolution_ / 2;
  std::vector<Index> tile(pixelsOf(resolution_));
  const std::string problem = onDevice([&] {
    const Batch batch{0, 1, 0};
    describe(batch, describe_view);
    draw(batch);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, width, height, GL_RED_INTEGER, GL_UNSIGNED_INT, tile.data());
    check("reading pictures");
  });
  if (!problem.empty()) throw RunError(problem);
  // The faces lie where kClipTriangles places them.
  const int r = resolution_;
  const std::array<std::array<int, 2>, kFaces> corners = {
      {{0, 0}, {r, 0}, {r, r / 2}, {0, r}, {r, r}}};
  std::vector<Index> pixels;
  for (std::size_t face = 0; face < kFaces; ++face) {
    for (int y = 0; y < (face == 0 ? r : r / 2); ++y) {
      const auto* row = tile.data() + (corners[face][1] + y) * width + corners[face][0];
      pixels.insert(pixels.end(), row, row + r);
    }
  }
  return pixels;
}

}  // namespace radiosity::gl
