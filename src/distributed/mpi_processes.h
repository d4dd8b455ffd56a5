// Processes by MPI.
#pragma once

#include <mpi.h>

#include "base/processes.h"

namespace radiosity {

class MpiProcesses final : public Processes {
 public:
  /// Starts MPI and, with it, PETSc, whose options are those of the environment (PETSC_OPTIONS) and
  /// of its own files.
  MpiProcesses();
  int rank() const override { return rank_; }
  int size() const override { return size_; }
  void send(int to, std::span<const std::byte> bytes) override;
  bool hasMessage() override;
  Message receive(int from, const WhileWaiting& waiting) override;
  void broadcast(std::span<std::byte> bytes, const WhileWaiting& waiting) override;
  void sum(std::span<double> values, const WhileWaiting& waiting) override;
  std::vector<std::vector<std::byte>> exchange(std::vector<std::vector<std::byte>> messages,
                                               const WhileWaiting& waiting) override;
  KrylovOutcome solve(const KrylovProblem& problem, std::span<double> solution) override;
  void finish() override;
  [[noreturn]] void abort(int code) override;

 private:
  static void wait(MPI_Request& request, const WhileWaiting& waiting);
  /// Returns when all processes have called it.
  static void meet(const WhileWaiting& waiting);
  int rank_ = 0;
  int size_ = 1;
};

}  // namespace radiosity
