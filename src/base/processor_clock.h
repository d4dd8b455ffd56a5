// The time that a thread really had a processor, and the time that passed.
#pragma once

#include <chrono>
#include <ctime>

namespace radiosity {

/// Processor seconds of this thread: time that other work on the machine takes is not counted.
inline double processorSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

/// Seconds from some moment on, by the clock.
inline double clockSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Measures by the clock from its construction on.
class Stopwatch {
 public:
  double seconds() const { return clockSeconds() - start_; }

 private:
  double start_ = clockSeconds();
};

/// Time of some work by both clocks; their ratio says how busy the machine is with other things.
struct BothClocks {
  double processor = 0;
  double clock = 0;
  BothClocks& operator+=(const BothClocks& other) {
    processor += other.processor;
    clock += other.clock;
    return *this;
  }
  /// 1 at least: clocks tick differently.
  double ratio() const { return clock > processor && processor > 0 ? clock / processor : 1.0; }
};

/// Measures from its construction on, on this thread.
class BothWatches {
 public:
  BothClocks elapsed() const { return {processorSeconds() - processor_, clockSeconds() - clock_}; }

 private:
  double processor_ = processorSeconds();
  double clock_ = clockSeconds();
};

}  // namespace radiosity
