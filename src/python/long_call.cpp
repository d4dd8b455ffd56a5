#include "long_call.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace py = pybind11;

namespace radiosity::python {
namespace {

constexpr std::chrono::milliseconds kBetweenLooks{50};

/// Keeps where the work is, to be asked from another thread.
class WatchedProgress : public Progress {
 public:
  void begin(const std::string& stage, std::size_t total, const std::string& steps,
             std::size_t done) override {
    const std::lock_guard lock(mutex_);
    stage_ = stage;
    steps_ = steps;
    total_ = total;
    done_ = done;
  }
  void advance(std::size_t steps) override { done_ += steps; }

  void tell(const py::object& report) const {
    std::unique_lock lock(mutex_);
    if (stage_.empty()) return;
    const std::string stage = stage_;
    const std::string steps = steps_;
    const std::size_t total = total_;
    lock.unlock();
    report(stage, std::min<std::size_t>(done_, total), total, steps);
  }

 private:
  mutable std::mutex mutex_;
  std::string stage_;
  std::string steps_;
  std::size_t total_ = 0;
  std::atomic<std::size_t> done_{0};
};

/// The work on its thread, and whether it is over.
class Worker {
 public:
  Worker(const std::function<void(Progress&)>& work, Progress& progress)
      : thread_([this, &work, &progress] {
          try {
            work(progress);
          } catch (...) {
            failure_ = std::current_exception();
          }
          const std::lock_guard lock(mutex_);
          over_ = true;
          changed_.notify_one();
        }) {}

  /// True once the work is over.
  bool wait() {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kBetweenLooks, [this] { return over_; });
  }
  /// What the work threw, once it is over.
  std::exception_ptr join() {
    thread_.join();
    return failure_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool over_ = false;
  std::exception_ptr failure_;
  std::jthread thread_;  // starts last, ends first
};

}  // namespace

void runLong(const py::object& report, const std::function<void(Progress&)>& work) {
  WatchedProgress progress;
  std::optional<py::error_already_set> raised;
  std::exception_ptr failure;
  {
    const py::gil_scoped_release unlocked;
    Worker worker(work, progress);
    while (!worker.wait()) {
      if (progress.cancelled()) continue;
      const py::gil_scoped_acquire locked;
      try {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        if (!report.is_none()) progress.tell(report);
      } catch (const py::error_already_set& error) {
        raised.emplace(error);
        progress.cancel();
      }
    }
    failure = worker.join();
  }
  if (raised) throw py::error_already_set(std::move(*raised));
  if (failure) std::rethrow_exception(failure);
}

}  // namespace radiosity::python
