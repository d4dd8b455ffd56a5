#include "distributed/mpi_processes.h"

#include <petscsys.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "distributed/petsc_solve.h"

namespace radiosity {

namespace {

constexpr int kLength = 1;  // tag of the length of a message
constexpr int kBytes = 2;   // tag of its bytes
/// MPI counts in ints, so longer messages are sent in parts.
constexpr std::size_t kMostBytes = std::size_t(1) << 30;

/// The most bytes that a collective call sends in one step. A longer one takes many steps, and in
/// each a process that sleeps keeps the others waiting, so all meet before it and it does not
/// sleep.
constexpr std::size_t kOneStep = std::size_t(4) << 10;

/// Waits without taking a core from processes that compute. The first waits are short, for answers
/// that come at once.
class Patience {
 public:
  void wait(const WhileWaiting& waiting) {
    constexpr int kBusy = 200;
    constexpr std::chrono::microseconds kShort{20};
    constexpr std::chrono::microseconds kLong{1000};
    if (++times_ < kBusy) {
      std::this_thread::yield();
      return;
    }
    std::this_thread::sleep_for(times_ < 2 * kBusy ? kShort : kLong);
    if (waiting) waiting();
  }

 private:
  int times_ = 0;
};

/// Calls move(offset, count) for parts of `size` that MPI can count.
template <class Move>
void inParts(std::size_t size, std::size_t most, const Move& move) {
  for (std::size_t at = 0; at < size; at += most) move(at, int(std::min(most, size - at)));
}

}  // namespace

MpiProcesses::MpiProcesses() {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
  // The program handles signals itself; PETSc would print its call stack.
  PetscOptionsSetValue(nullptr, "-no_signal_handler", nullptr);
  PetscInitializeNoArguments();
  // PETSc returns its errors, and we throw exceptions that describe them in one line.
  PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
}

void MpiProcesses::wait(MPI_Request& request, const WhileWaiting& waiting) {
  Patience patience;
  for (int done = 0;;) {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done != 0) return;
    patience.wait(waiting);
  }
}

void MpiProcesses::send(int to, std::span<const std::byte> bytes) {
  unsigned long long length = bytes.size();
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Isend(&length, 1, MPI_UNSIGNED_LONG_LONG, to, kLength, MPI_COMM_WORLD, &request);
  wait(request, {});
  inParts(bytes.size(), kMostBytes, [&](std::size_t at, int count) {
    MPI_Isend(bytes.data() + at, count, MPI_BYTE, to, kBytes, MPI_COMM_WORLD, &request);
    wait(request, {});
  });
}

bool MpiProcesses::hasMessage() {
  int there = 0;
  MPI_Iprobe(MPI_ANY_SOURCE, kLength, MPI_COMM_WORLD, &there, MPI_STATUS_IGNORE);
  return there != 0;
}

Processes::Message MpiProcesses::receive(int from, const WhileWaiting& waiting) {
  const int source = from == kAny ? MPI_ANY_SOURCE : from;
  unsigned long long length = 0;
  MPI_Status status{};
  Patience patience;
  for (int there = 0; there == 0;) {
    MPI_Iprobe(source, kLength, MPI_COMM_WORLD, &there, &status);
    if (there == 0) patience.wait(waiting);
  }
  Message message;
  message.from = status.MPI_SOURCE;
  MPI_Recv(&length, 1, MPI_UNSIGNED_LONG_LONG, message.from, kLength, MPI_COMM_WORLD,
           MPI_STATUS_IGNORE);
  message.bytes.resize(length);
  inParts(message.bytes.size(), kMostBytes, [&](std::size_t at, int count) {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Irecv(message.bytes.data() + at, count, MPI_BYTE, message.from, kBytes, MPI_COMM_WORLD,
              &request);
    wait(request, waiting);
  });
  return message;
}

void MpiProcesses::meet(const WhileWaiting& waiting) {
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibarrier(MPI_COMM_WORLD, &request);
  wait(request, waiting);
}

// MPI_Ibcast() and MPI_Ireduce() even where all have met: with MPI_Bcast() and MPI_Reduce() a
// process of four took about 10 MB more.

void MpiProcesses::broadcast(std::span<std::byte> bytes, const WhileWaiting& waiting) {
  const bool one_step = bytes.size() <= kOneStep;
  if (!one_step) meet(waiting);
  inParts(bytes.size(), kMostBytes, [&](std::size_t at, int count) {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibcast(bytes.data() + at, count, MPI_BYTE, 0, MPI_COMM_WORLD, &request);
    if (one_step) wait(request, waiting);
    MPI_Wait(&request, MPI_STATUS_IGNORE);  // returns at once from a request that is done
  });
}

void MpiProcesses::sum(std::span<double> values, const WhileWaiting& waiting) {
  meet(waiting);
  inParts(values.size(), kMostBytes / sizeof(double), [&](std::size_t at, int count) {
    MPI_Request request = MPI_REQUEST_NULL;
    double* mine = values.data() + at;
    MPI_Ireduce(rank_ == 0 ? MPI_IN_PLACE : mine, rank_ == 0 ? mine : nullptr, count, MPI_DOUBLE,
                MPI_SUM, 0, MPI_COMM_WORLD, &request);
    MPI_Wait(&request, MPI_STATUS_IGNORE);
  });
}

std::vector<std::vector<std::byte>> MpiProcesses::exchange(
    std::vector<std::vector<std::byte>> messages, const WhileWaiting& waiting) {
  std::vector<unsigned long long> lengths;
  lengths.reserve(messages.size());
  for (const std::vector<std::byte>& message : messages) lengths.push_back(message.size());
  std::vector<MPI_Request> sent;
  for (int p = 0; p < size_; ++p) {
    if (p == rank_) continue;
    const std::vector<std::byte>& message = messages[std::size_t(p)];
    MPI_Isend(&lengths[std::size_t(p)], 1, MPI_UNSIGNED_LONG_LONG, p, kLength, MPI_COMM_WORLD,
              &sent.emplace_back());
    inParts(message.size(), kMostBytes, [&](std::size_t at, int count) {
      MPI_Isend(message.data() + at, count, MPI_BYTE, p, kBytes, MPI_COMM_WORLD,
                &sent.emplace_back());
    });
  }
  std::vector<std::vector<std::byte>> received(messages.size());
  for (int p = 0; p < size_; ++p) {
    if (p != rank_) received[std::size_t(p)] = receive(p, waiting).bytes;
  }
  for (MPI_Request& request : sent) wait(request, waiting);
  return received;
}

KrylovOutcome MpiProcesses::solve(const KrylovProblem& problem, std::span<double> solution) {
  return petscSolve(problem, solution);
}

void MpiProcesses::finish() {
  PetscFinalize();
  MPI_Finalize();
}

void MpiProcesses::abort(int code) {
  MPI_Abort(MPI_COMM_WORLD, code);
  std::abort();
}

}  // namespace radiosity

extern "C" [[gnu::visibility("default")]] radiosity::Processes* radiosityProcesses() {
  static radiosity::MpiProcesses processes;
  return &processes;
}
