// Clocks and repeated timings.
#pragma once

#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <vector>

namespace radiosity::bench {

/// Seconds. On a machine that others use, too, the processor times count no waiting.
struct Seconds {
  double user = 0;    ///< of all threads
  double system = 0;  ///< mostly the kernel clearing the memory that the matrix takes
  double wall = 0;
  double processor() const { return user + system; }
};

/// Runs from its construction on; times of the whole process.
class Stopwatch {
 public:
  Stopwatch() : start_(now()) {}
  Seconds elapsed() const {
    const Seconds end = now();
    return {end.user - start_.user, end.system - start_.system, end.wall - start_.wall};
  }

 private:
  static double seconds(const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); }
  static Seconds now() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto wall = std::chrono::steady_clock::now().time_since_epoch();
    return {seconds(usage.ru_utime), seconds(usage.ru_stime),
            std::chrono::duration<double>(wall).count()};
  }
  Seconds start_;
};

struct Timing {
  Seconds seconds;  ///< of the run that took the least processor time
  int runs = 0;
};

/// run() makes one run and returns its time. Short ones are repeated until they add up to two
/// seconds, at most five times.
template <class Run>
Timing leastOfRuns(const Run& run) {
  constexpr double kEnoughSeconds = 2;
  constexpr int kMostRuns = 5;
  Timing timing{run(), 1};
  for (double total = timing.seconds.wall; total < kEnoughSeconds && timing.runs < kMostRuns;
       ++timing.runs) {
    const Seconds again = run();
    total += again.wall;
    if (again.processor() < timing.seconds.processor()) timing.seconds = again;
  }
  return timing;
}

/// Seconds this thread has had the processor.
inline double threadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

/// The least of several timings, which excludes other jobs' use of shared caches.
inline double least(const std::vector<double>& times) {
  return *std::min_element(times.begin(), times.end());
}

}  // namespace radiosity::bench
