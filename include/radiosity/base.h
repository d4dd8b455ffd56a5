// Vectors, errors, progress and the thread count, for every room.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <stdexcept>
#include <string>

namespace [[gnu::visibility("default")]] radiosity {

using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;
using Index = std::uint32_t;

/// The index of an element that does not exist: an absent texture, camera or twin.
inline constexpr Index kNone = 0xffffffffu;

/// Bad input or arguments: one line with the file, the element in it and the cure. Exit code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The run itself failed (disk full, memory limit). Exit code 1.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Thrown out of a long computation after Progress::cancel(); no half-written file remains.
class Cancelled : public RunError {
 public:
  Cancelled() : RunError("interrupted; nothing was written") {}
};

/// Receives the progress of a long computation. The default one is silent. advance() and
/// cancelled() may be called from any thread.
class Progress {
 public:
  virtual ~Progress() = default;
  /// Begins a stage of `total` steps of about equal length, of which `done` are done already.
  /// `steps`: their name ("rows"); empty: a person would not count them.
  virtual void begin(const std::string& /*stage*/, std::size_t /*total*/,
                     const std::string& /*steps*/ = {}, std::size_t /*done*/ = 0) {}
  virtual void advance(std::size_t /*steps*/ = 1) {}
  virtual void end() {}
  void cancel() { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }
  /// Throws Cancelled once cancel() was called. Call it between steps, on the calling thread.
  void check() const {
    if (cancelled()) throw Cancelled();
  }

 private:
  std::atomic<bool> cancelled_{false};
};

/// Limits all later parallel work of the process to `threads` threads (0: all cores). Results have
/// the same bits for any number.
void setThreads(int threads);

}  // namespace radiosity
