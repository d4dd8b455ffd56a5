#include "long_call.h"

#include <cxxabi.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
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

  void start(std::function<void()> work) {
    {
      const std::lock_guard lock(mutex_);
      work_ = std::move(work);
      failure_ = nullptr;
    }
    changed_.notify_one();
  }

  /// True once the work is over.
  bool wait(std::chrono::milliseconds longest) {
    std::unique_lock lock(mutex_);
    return over_.wait_for(lock, longest, [this] { return work_ == nullptr; });
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
        work_();
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
  std::function<void()> work_;       // empty once it is over
  std::exception_ptr failure_;
  bool ended_ = false;
  std::jthread thread_{[this] { run(); }};  // starts last, ends first
};

/// The workers without a call: at most as many as there were calls at once.
class IdleWorkers {
 public:
  ~IdleWorkers() { forgetThoseOfTheParent(); }
  std::unique_ptr<Worker> take() {
    const std::lock_guard lock(mutex_);
    forgetThoseOfTheParent();
    takeBackThoseLeft();
    if (idle_.empty()) return std::make_unique<Worker>();
    std::unique_ptr<Worker> worker = std::move(idle_.back());
    idle_.pop_back();
    return worker;
  }
  void giveBack(std::unique_ptr<Worker> worker) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(worker));
  }
  /// Keeps a worker whose work is not over yet, though nobody waits for it any more.
  void leave(std::unique_ptr<Worker> worker) {
    const std::lock_guard lock(mutex_);
    left_.push_back(std::move(worker));
  }

 private:
  void takeBackThoseLeft() {
    for (std::unique_ptr<Worker>& worker : left_) {
      if (worker->wait(std::chrono::milliseconds(0))) idle_.push_back(std::move(worker));
    }
    std::erase(left_, nullptr);
  }
  /// A forked process has copies of the workers without their threads, which cannot be joined.
  void forgetThoseOfTheParent() {
    if (std::exchange(process_, getpid()) == getpid()) return;
    for (std::vector<std::unique_ptr<Worker>>* workers : {&idle_, &left_}) {
      for (std::unique_ptr<Worker>& worker : *workers) static_cast<void>(worker.release());
      workers->clear();
    }
  }

  std::mutex mutex_;
  std::vector<std::unique_ptr<Worker>> idle_;
  std::vector<std::unique_ptr<Worker>> left_;
  pid_t process_ = getpid();
};

IdleWorkers& idleWorkers() {
  static IdleWorkers workers;
  return workers;
}

bool pythonEnds() {
#if PY_VERSION_HEX >= 0x030D0000
  return Py_IsFinalizing() != 0;
#else
  return _Py_IsFinalizing() != 0;
#endif
}

/// Gives up Python's lock. Once the process ends, Python ends other threads that ask for the lock,
/// by an exception that no destructor may meet, since the work goes on; such a thread waits here
/// for its end instead.
class Unlocked {
 public:
  Unlocked() = default;
  ~Unlocked() { lock(); }
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

  void lock() {
    if (state_ == nullptr) return;
    while (!at_end_ && pythonEnds()) std::this_thread::sleep_for(kBetweenLooks);
    try {
      PyEval_RestoreThread(std::exchange(state_, nullptr));
    } catch (const abi::__forced_unwind&) {  // the end began while we waited for the lock
      while (true) std::this_thread::sleep_for(kBetweenLooks);
    }
  }
  void unlock() { state_ = PyEval_SaveThread(); }

 private:
  bool at_end_ = pythonEnds();  ///< the thread that ends the process, in a finalizer
  PyThreadState* state_ = PyEval_SaveThread();
};

/// The work that goes on now. What it uses is taken apart as the process ends, so it ends before.
class GoingWork {
 public:
  /// Never taken apart itself.
  static GoingWork& all() {
    static auto* const works = new GoingWork;
    return *works;
  }

  /// Does `work`; `progress`: null if it cannot be cancelled.
  template <class Work>
  void run(Progress* progress, const Work& work) {
    add(progress);
    try {
      work();
    } catch (...) {
      remove(progress);
      throw;
    }
    remove(progress);
  }

  /// Python is at its end, so that no new work begins.
  void end() {
    constexpr std::chrono::seconds kLongest{5};  // for what cannot be cancelled
    std::unique_lock lock(mutex_);
    for (Progress* progress : going_) {
      if (progress != nullptr) progress->cancel();
    }
    over_.wait_for(lock, kLongest, [this] { return going_.empty(); });
  }

 private:
  void add(Progress* progress) {
    const std::lock_guard lock(mutex_);
    going_.insert(progress);
  }
  void remove(Progress* progress) {
    {
      const std::lock_guard lock(mutex_);
      going_.erase(going_.find(progress));
    }
    over_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable over_;
  std::multiset<Progress*> going_;
};

/// Runs `work` on a worker. Every 50 ms `look` is called with Python's lock; if it throws an error
/// of Python, interrupt() says whether we still wait for the work, and the error is thrown in the
/// end.
void runOnWorker(std::function<void()> work, const std::function<void()>& look,
                 const std::function<bool()>& interrupt) {
  std::optional<py::error_already_set> raised;
  std::exception_ptr failure;
  {
    Unlocked unlocked;
    std::unique_ptr<Worker> worker = idleWorkers().take();
    worker->start(std::move(work));
    bool waits = true;
    while (waits && !worker->wait(kBetweenLooks)) {
      if (raised) continue;
      unlocked.lock();
      try {
        look();
      } catch (const py::error_already_set& error) {
        raised.emplace(error);
        waits = interrupt();
      }
      unlocked.unlock();
    }
    if (waits) {
      failure = worker->failure();
      idleWorkers().giveBack(std::move(worker));
    } else {
      idleWorkers().leave(std::move(worker));
    }
  }
  if (raised) throw py::error_already_set(std::move(*raised));
  if (failure) std::rethrow_exception(failure);
}

void handleSignals() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

/// Looks for signals at the steps of work on the calling thread.
class LookingProgress : public WatchedProgress {
 public:
  LookingProgress(const py::object& report, Unlocked& unlocked)
      : report_(report), unlocked_(unlocked) {}
  void begin(const std::string& stage, std::size_t total, const std::string& steps,
             std::size_t done) override {
    WatchedProgress::begin(stage, total, steps, done);
    look();
  }
  void advance(std::size_t steps) override {
    WatchedProgress::advance(steps);
    look();
  }
  /// Throws the error of Python that ended the work, if one did; call it with Python's lock.
  void rethrow() {
    if (raised_) throw py::error_already_set(std::move(*raised_));
  }

 private:
  using Clock = std::chrono::steady_clock;

  void look() {
    const Clock::time_point now = Clock::now();
    if (std::this_thread::get_id() != caller_ || raised_ || now < next_) return;
    next_ = now + kBetweenLooks;
    unlocked_.lock();
    try {
      handleSignals();
      if (!report_.is_none()) tell(report_);
    } catch (const py::error_already_set& error) {
      raised_.emplace(error);
      cancel();
    }
    unlocked_.unlock();
  }

  const py::object& report_;
  Unlocked& unlocked_;
  std::thread::id caller_ = std::this_thread::get_id();
  Clock::time_point next_ = Clock::now() + kBetweenLooks;
  std::optional<py::error_already_set> raised_;
};

}  // namespace

void runLong(const py::object& report, const std::function<void(Progress&)>& work) {
  WatchedProgress progress;
  const auto look = [&] {
    handleSignals();
    if (!report.is_none()) progress.tell(report);
  };
  const auto cancel = [&] {
    progress.cancel();
    return true;
  };
  runOnWorker([&] { GoingWork::all().run(&progress, [&] { work(progress); }); }, look, cancel);
}

void runShortSteps(const py::object& report, const std::function<void(Progress&)>& work) {
  Unlocked unlocked;
  LookingProgress progress(report, unlocked);
  std::exception_ptr failure;
  try {
    GoingWork::all().run(&progress, [&] { work(progress); });
  } catch (...) {
    failure = std::current_exception();
  }
  unlocked.lock();
  progress.rethrow();
  if (failure) std::rethrow_exception(failure);
}

void runWithoutSteps(const std::function<void()>& work) {
  runOnWorker([work] { GoingWork::all().run(nullptr, work); }, handleSignals, [] { return false; });
}

void endWorkWithProcess() {
  Py_AtExit([] { GoingWork::all().end(); });
}

}  // namespace radiosity::python
