#include "matrix/ordered_sums.h"

#include <algorithm>
#include <span>
#include <utility>

#include "base/byte_stream.h"
#include "base/parallel.h"
#include "matrix/own_rows.h"
#include "matrix/triangle_kernels.h"
#include "matrix/triangle_pass.h"

namespace radiosity {

namespace {

/// Rows of a chunk that follow one another and are one process's.
struct Stretch {
  std::size_t first;
  std::size_t last;
  int owner;
};

/// Stretches of rows [first, last), without rows that hold nothing.
std::vector<Stretch> stretchesOf(const RowOwners& owners, std::size_t first, std::size_t last) {
  std::vector<Stretch> stretches;
  for (std::size_t k = first; k < last; ++k) {
    const int owner = owners.owner[k];
    if (owner == RowOwners::kNobody) continue;
    if (stretches.empty() || stretches.back().owner != owner) stretches.push_back({k, k, owner});
    stretches.back().last = k + 1;
  }
  return stretches;
}

/// The chunks of a TrianglePass whose stretches are added by their owners. Chunks do not depend on
/// each other, so all owners work at once: on the first stretch of every chunk, then on the second,
/// and so on.
class ChunkedSums {
 public:
  ChunkedSums(Processes& processes, const SymmetricMatrix& own, const RowOwners& owners,
              const TrianglePass& pass)
      : processes_(processes), own_(own), ones_(own.size() + kOverrun, 1.0) {
    for (std::size_t c = 0; c + 1 < pass.starts().size(); ++c) {
      chunks_.push_back(
          {pass.starts()[c], stretchesOf(owners, pass.starts()[c], pass.starts()[c + 1]), {}});
      steps_ = std::max(steps_, chunks_.back().stretches.size());
    }
  }

  /// Adds the sums of own rows to `gathered`. Process 0 gets in `scattered` what rows scatter to
  /// later ones.
  void run(std::span<double> gathered, std::span<double> scattered, const WhileWaiting& waiting) {
    for (std::size_t step = 0; step < steps_; ++step) {
      parallelFor(chunks_.size(), 1,
                  [&](std::size_t c) { addStretch(chunks_[c], step, gathered); });
      passOn(step, waiting);
    }
    for (const Chunk& chunk : chunks_) {  // filled in process 0 alone
      for (std::size_t k = 0; k < chunk.sums.size() && chunk.begin + k < scattered.size(); ++k) {
        scattered[chunk.begin + k] += chunk.sums[k];
      }
    }
  }

 private:
  struct Chunk {
    std::size_t begin;
    std::vector<Stretch> stretches;
    /// Scattered to rows from `begin` on, where this process adds or has added the last stretch.
    std::vector<double> sums;
  };

  void addStretch(Chunk& chunk, std::size_t step, std::span<double> gathered) const {
    if (step >= chunk.stretches.size()) return;
    const auto& [first, last, owner] = chunk.stretches[step];
    if (owner != processes_.rank()) return;
    if (step == 0) chunk.sums.assign(own_.size() - chunk.begin + kOverrun, 0.0);
    for (std::size_t k = first; k < last; ++k) {
      gathered[k] = sumRow(own_, k, chunk.begin, ones_, chunk.sums);
    }
  }

  /// The process that adds a chunk's next stretch after `step`, or takes all sums: 0.
  static int nextOwner(const Chunk& chunk, std::size_t step) {
    return step + 1 < chunk.stretches.size() ? chunk.stretches[step + 1].owner : 0;
  }

  /// Sends the sums of chunks that had a stretch in this step to where they are added to next.
  void passOn(std::size_t step, const WhileWaiting& waiting) {
    const int rank = processes_.rank();
    std::vector<ByteWriter> messages(std::size_t(processes_.size()));
    for (Chunk& chunk : chunks_) {
      if (step >= chunk.stretches.size() || chunk.stretches[step].owner != rank) continue;
      const int next = nextOwner(chunk, step);
      if (next == rank) continue;
      messages[std::size_t(next)].putArray(std::span<const double>(chunk.sums));
      chunk.sums = {};
    }
    std::vector<std::vector<std::byte>> bytes;
    bytes.reserve(messages.size());
    for (ByteWriter& message : messages) bytes.push_back(message.take());
    const std::vector<std::vector<std::byte>> received =
        processes_.exchange(std::move(bytes), waiting);
    std::vector<ByteReader> from(received.begin(), received.end());
    for (Chunk& chunk : chunks_) {
      if (step >= chunk.stretches.size() || nextOwner(chunk, step) != rank) continue;
      const int before = chunk.stretches[step].owner;
      if (before != rank) chunk.sums = from[std::size_t(before)].getArray<double>();
    }
  }

  Processes& processes_;
  const SymmetricMatrix& own_;
  std::vector<double> ones_;
  std::vector<Chunk> chunks_;
  std::size_t steps_ = 0;
};

}  // namespace

std::vector<double> orderedRowSums(Processes& processes, const ExchangeMatrix& own,
                                   const RowOwners& owners, const WhileWaiting& waiting) {
  const std::size_t n = own.size();
  const bool first_process = processes.rank() == 0;
  const auto* const triangle = dynamic_cast<const SymmetricMatrix*>(&own);
  if (triangle == nullptr) {  // a row is one process's: the others add 0
    std::vector<double> sums = own.rowSums();
    processes.sum(sums, waiting);
    return first_process ? sums : std::vector<double>();
  }
  const TrianglePass pass(n, kSums, [&](std::size_t k) { return owners.work[k]; });
  std::vector<double> gathered(n, 0.0);
  std::vector<double> scattered(first_process ? n : 0, 0.0);
  for (std::size_t k = 0; k < n; ++k) gathered[k] = triangle->diagonal(k);
  ChunkedSums(processes, *triangle, owners, pass).run(gathered, scattered, waiting);
  processes.sum(gathered, waiting);
  if (!first_process) return {};
  std::vector<double> sums(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double area = own.area()[own.order()[k]];
    sums[own.order()[k]] = gathered[k] + (area > 0 ? scattered[k] / area : 0.0);
  }
  return sums;
}

}  // namespace radiosity
