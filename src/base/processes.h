// The processes of one run under mpirun, seen from one of them. The code that calls MPI is a
// library of its own (src/distributed). It is opened only if there are such processes, so the
// program also runs where no MPI is installed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/krylov_problem.h"

namespace radiosity {

/// The next task that process 0 gives to the others.
enum class SharedTask : std::uint32_t {
  end,           ///< to finish
  mesh,          ///< to mesh the scene, while process 0 does
  form_factors,  ///< src/formfactor/shared_factors.h
  stored_matrix  ///< to read a share of the rows of a results file
};

/// Called by a waiting process some hundred times a second; may throw.
using WhileWaiting = std::function<void()>;

class Processes {
 public:
  /// Stands for any sender.
  static constexpr int kAny = -1;
  struct Message {
    int from = kAny;
    std::vector<std::byte> bytes;
  };

  virtual ~Processes() = default;
  virtual int rank() const = 0;  ///< from 0; 0 is the one that runs the command
  virtual int size() const = 0;

  // ---- Called by one thread at a time. Waiting takes no processor time.

  virtual void send(int to, std::span<const std::byte> bytes) = 0;
  /// Whether a message has arrived.
  virtual bool hasMessage() = 0;
  virtual Message receive(int from, const WhileWaiting& waiting = {}) = 0;

  // ---- Called by all processes, in the same order.

  /// Sends the bytes of process 0 to all; all have spans of one length.
  virtual void broadcast(std::span<std::byte> bytes, const WhileWaiting& waiting = {}) = 0;
  /// Process 0 gets the sums over all processes; the others keep what they have.
  virtual void sum(std::span<double> values, const WhileWaiting& waiting = {}) = 0;
  /// Each process sends messages[p] to process p, and gets what process p sent to it as element p.
  /// Its own message is dropped.
  virtual std::vector<std::vector<std::byte>> exchange(std::vector<std::vector<std::byte>> messages,
                                                       const WhileWaiting& waiting = {}) = 0;
  /// Solves with PETSc's KSP. `solution`: rows * bands, in process 0; empty in the others. Errors:
  /// RunError if PETSc fails.
  virtual KrylovOutcome solve(const KrylovProblem& problem, std::span<double> solution) = 0;

  // ---- The end.

  /// Called by all, last.
  virtual void finish() = 0;
  /// Ends all processes at once.
  [[noreturn]] virtual void abort(int code) = 0;

  /// Whether a step of all processes was left half done. Then no further common step is possible,
  /// and the run must end by abort().
  bool halfDone() const { return half_done_ > 0; }

  template <class Value>
  void broadcastValue(Value& value, const WhileWaiting& waiting = {}) {
    static_assert(std::is_trivially_copyable_v<Value>);
    broadcast(std::as_writable_bytes(std::span(&value, 1)), waiting);
  }
  template <class Value>
  void broadcastArray(std::vector<Value>& values, const WhileWaiting& waiting = {}) {
    std::size_t count = values.size();
    broadcastValue(count, waiting);
    values.resize(count);
    broadcast(std::as_writable_bytes(std::span(values)), waiting);
  }

 private:
  friend class SharedStep;
  int half_done_ = 0;
};

/// Marks a step that all processes do together, in process 0: an exception leaves it half done.
class SharedStep {
 public:
  explicit SharedStep(Processes& processes)
      : processes_(processes), exceptions_(std::uncaught_exceptions()) {
    ++processes_.half_done_;
  }
  ~SharedStep() {
    if (std::uncaught_exceptions() == exceptions_) --processes_.half_done_;
  }
  SharedStep(const SharedStep&) = delete;
  SharedStep& operator=(const SharedStep&) = delete;

 private:
  Processes& processes_;
  int exceptions_;
};

/// Whether a launcher of MPI programs started this process, judged by the environment variables
/// that it sets.
bool startedByMpi();

/// This run's processes. Opens the library at the first call. Precondition: startedByMpi(). Errors:
/// RunError if the library is not beside this one.
Processes& joinProcesses();

}  // namespace radiosity
