#include "long_call.h"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace py = pybind11;

namespace radiosity::python {
namespace {

constexpr std::chrono::milliseconds kBetweenLooks{50};

/// Keeps the progress of the work for another thread to ask.
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

/// A thread that does one piece of work after the other. A kept thread is already known to TBB and
/// to the heap; to start a new one may take longer than a small solve.
class Worker {
 public:
  ~Worker() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    changed_.notify_one();
  }  // the thread's own destructor joins it

  /// Both arguments must live until the work is over.
  void start(const std::function<void(Progress&)>& work, Progress& progress) {
    {
      const std::lock_guard lock(mutex_);
      work_ = &work;
      progress_ = &progress;
      failure_ = nullptr;
    }
    changed_.notify_one();
  }

  /// True once the work is over.
  bool wait() {
    std::unique_lock lock(mutex_);
    return over_.wait_for(lock, kBetweenLooks, [this] { return work_ == nullptr; });
  }

  /// The exception that the work threw; call it once the work is over.
  std::exception_ptr failure() { return std::exchange(failure_, nullptr); }

 private:
  void run() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return ended_ || work_ != nullptr; });
      if (work_ == nullptr) return;
      lock.unlock();
      std::exception_ptr failure;
      try {
        (*work_)(*progress_);
      } catch (...) {
        failure = std::current_exception();
      }
      lock.lock();
      failure_ = failure;
      work_ = nullptr;
      over_.notify_one();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;  // the thread waits for it
  std::condition_variable over_;     // the caller waits for it
  const std::function<void(Progress&)>* work_ = nullptr;
  Progress* progress_ = nullptr;
  std::exception_ptr failure_;
  bool ended_ = false;
  std::jthread thread_{[this] { run(); }};  // starts last, ends first
};

/// The idle workers: at most as many as there were calls at once.
class IdleWorkers {
 public:
  std::unique_ptr<Worker> take() {
    const std::lock_guard lock(mutex_);
    forgetThoseOfTheParent();
    if (idle_.empty()) return std::make_unique<Worker>();
    std::unique_ptr<Worker> worker = std::move(idle_.back());
    idle_.pop_back();
    return worker;
  }
  void giveBack(std::unique_ptr<Worker> worker) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(worker));
  }

 private:
  /// A forked process has copies of the workers without their threads, which cannot be joined.
  void forgetThoseOfTheParent() {
    if (std::exchange(process_, getpid()) == getpid()) return;
    for (std::unique_ptr<Worker>& worker : idle_) static_cast<void>(worker.release());
    idle_.clear();
  }

  std::mutex mutex_;
  std::vector<std::unique_ptr<Worker>> idle_;
  pid_t process_ = getpid();
};

IdleWorkers& idleWorkers() {
  static IdleWorkers workers;
  return workers;
}

}  // namespace

void runLong(const py::object& report, const std::function<void(Progress&)>& work) {
  WatchedProgress progress;
  std::optional<py::error_already_set> raised;
  std::exception_ptr failure;
  {
    const py::gil_scoped_release unlocked;
    std::unique_ptr<Worker> worker = idleWorkers().take();
    worker->start(work, progress);
    while (!worker->wait()) {
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
    failure = worker->failure();
    idleWorkers().giveBack(std::move(worker));
  }
  if (raised) throw py::error_already_set(std::move(*raised));
  if (failure) std::rethrow_exception(failure);
}

}  // namespace radiosity::python
