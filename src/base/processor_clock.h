// Processor time of a thread or of the process, and time by the clock.
#pragma once

#include <chrono>
#include <ctime>

namespace radiosity {

/// Processor seconds of this thread: they do not count other work on the machine.
inline double processorSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

/// Processor seconds of all threads of this process.
inline double processSeconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

/// Seconds by the clock since a fixed moment.
inline double clockSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Measures time by the clock since its construction.
class Stopwatch {
 public:
  double seconds() const { return clockSeconds() - start_; }

 private:
  double start_ = clockSeconds();
};

/// Time of some work by both clocks; their ratio says how busy the machine is with other work.
struct BothClocks {
  double processor = 0;
  double clock = 0;
  BothClocks& operator+=(const BothClocks& other) {
    processor += other.processor;
    clock += other.clock;
    return *this;
  }
  /// At least 1, although the two clocks tick differently.
  double ratio() const { return clock > processor && processor > 0 ? clock / processor : 1.0; }
};

/// Measures both times of this thread since its construction.
class BothWatches {
 public:
  BothClocks elapsed() const { return {processorSeconds() - processor_, clockSeconds() - clock_}; }

 private:
  double processor_ = processorSeconds();
  double clock_ = clockSeconds();
};

}  // namespace radiosity
