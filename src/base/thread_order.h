// What the thread sanitizer cannot see of parallel loops. Empty in all other builds.
#pragma once

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace radiosity {

/// The order that a parallel loop keeps: all before it comes before its bodies, these before all
/// after it. The scheduler keeps it in a library that is not built for the sanitizer, which would
/// report every value that a body hands on. Made before the loop, it ends after it.
class ThreadOrder {
 public:
#if defined(__SANITIZE_THREAD__)
  ThreadOrder() { __tsan_release(&place_); }
  ~ThreadOrder() { __tsan_acquire(&place_); }
#else
  ThreadOrder() = default;
  ~ThreadOrder() {}  // NOLINT(modernize-use-equals-default): else a loop's is an unused variable
#endif
  ThreadOrder(const ThreadOrder&) = delete;
  ThreadOrder& operator=(const ThreadOrder&) = delete;

  /// A body, from its begin to its end.
  class Body {
   public:
    Body(const Body&) = delete;
    Body& operator=(const Body&) = delete;
#if defined(__SANITIZE_THREAD__)
    explicit Body(const ThreadOrder& order) : order_(order) { __tsan_acquire(&order_.place_); }
    ~Body() { __tsan_release(&order_.place_); }

   private:
    const ThreadOrder& order_;
#else
    explicit Body(const ThreadOrder& /*order*/) {}
    ~Body() {}  // NOLINT(modernize-use-equals-default)
#endif
  };

#if defined(__SANITIZE_THREAD__)
 private:
  mutable char place_ = 0;
#endif
};

}  // namespace radiosity
