#include "matrix/ordered_sums.h"

#include <span>

#include "base/byte_stream.h"
#include "matrix/own_rows.h"
#include "matrix/triangle_kernels.h"
#include "matrix/triangle_pass.h"

namespace radiosity {

namespace {

/// The sums of one chunk of rows. One process has them at a time.
class PassedSums {
 public:
  PassedSums(Processes& processes, std::size_t places, const WhileWaiting& waiting)
      : processes_(processes), waiting_(waiting), sums_(places, 0.0) {}

  /// Sends the sums to process `next` from the process that has them.
  void passTo(int next) {
    const int before = std::exchange(holder_, next);
    if (before == RowOwners::kNobody || before == next) return;
    if (before == processes_.rank()) {
      ByteWriter bytes;
      bytes.putArray(std::span<const double>(sums_));
      processes_.send(next, bytes.bytes());
    } else if (next == processes_.rank()) {
      const Processes::Message message = processes_.receive(before, waiting_);
      ByteReader bytes(message.bytes);
      sums_ = bytes.getArray<double>();
    }
  }
  std::span<double> values() { return sums_; }

 private:
  Processes& processes_;
  const WhileWaiting& waiting_;
  std::vector<double> sums_;
  int holder_ = RowOwners::kNobody;
};

}  // namespace

std::vector<double> orderedRowSums(Processes& processes, const ExchangeMatrix& own,
                                   const RowOwners& owners, const WhileWaiting& waiting) {
  const std::size_t n = own.size();
  const bool first_process = processes.rank() == 0;
  if (!own.isSymmetric()) {  // a row is one process's: the others add 0
    std::vector<double> sums = own.rowSums();
    processes.sum(sums, waiting);
    return first_process ? sums : std::vector<double>();
  }
  const TrianglePass pass(n, kSums, [&](std::size_t k) { return owners.work[k]; });
  const std::vector<double> ones(n + kOverrun, 1.0);
  std::vector<double> gathered(n, 0.0);
  std::vector<double> handed(n, 0.0);
  for (std::size_t k = 0; k < n; ++k) gathered[k] = own.diagonal(k);
  for (std::size_t c = 0; c + 1 < pass.starts().size(); ++c) {
    const std::size_t begin = pass.starts()[c];
    PassedSums sums(processes, n - begin + kOverrun, waiting);
    for (std::size_t k = begin; k < pass.starts()[c + 1]; ++k) {
      if (owners.owner[k] == RowOwners::kNobody) continue;
      sums.passTo(owners.owner[k]);
      if (owners.owner[k] != processes.rank()) continue;
      gathered[k] = sumRow(own, k, begin, ones, sums.values());
    }
    sums.passTo(0);
    for (std::size_t k = begin; first_process && k < n; ++k) handed[k] += sums.values()[k - begin];
  }
  processes.sum(gathered, waiting);
  if (!first_process) return {};
  std::vector<double> sums(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double area = own.area()[own.order()[k]];
    sums[own.order()[k]] = gathered[k] + (area > 0 ? handed[k] / area : 0.0);
  }
  return sums;
}

}  // namespace radiosity
