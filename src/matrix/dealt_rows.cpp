#include "matrix/dealt_rows.h"

#include <span>
#include <utility>
#include <vector>

#include "base/byte_stream.h"
#include "matrix/row_owners.h"
#include "matrix/run_bytes.h"

namespace radiosity {

namespace {

/// The approximate size of a message with rows.
constexpr std::size_t kMessageBytes = std::size_t(1) << 24;

/// The first row of each process's share, and the end.
std::vector<std::size_t> sharesOf(const SymmetricMatrix& whole, std::size_t processes) {
  const std::size_t n = whole.size();
  std::size_t total = 0;
  for (std::size_t k = 0; k < n; ++k) total += workOf(whole.upperRuns(k));
  std::vector<std::size_t> starts{0};
  std::size_t done = 0;
  for (std::size_t k = 0; k < n && starts.size() < processes; ++k) {
    done += workOf(whole.upperRuns(k));
    while (starts.size() < processes && done * processes >= starts.size() * total) {
      starts.push_back(k + 1);
    }
  }
  starts.resize(processes, n);
  starts.push_back(n);
  return starts;
}

void putRow(const SymmetricMatrix& matrix, std::size_t k, ByteWriter& bytes) {
  bytes.put(Index(k));
  bytes.put(matrix.diagonal(k));
  putRuns(matrix.upperRuns(k), matrix.precision(), bytes);
}

/// Sends rows `first` to `last` - 1 in messages, and an empty message at the end.
void sendRows(Processes& processes, int to, const SymmetricMatrix& whole, std::size_t first,
              std::size_t last, const WhileWaiting& waiting) {
  while (first < last) {
    ByteWriter bytes;
    while (first < last && bytes.bytes().size() < kMessageBytes) putRow(whole, first++, bytes);
    processes.send(to, bytes.bytes());
    if (waiting) waiting();
  }
  processes.send(to, {});
}

void takeRow(ByteReader& bytes, SymmetricMatrix& own) {
  const auto k = bytes.get<Index>();
  std::vector<Index> positions{k};
  std::vector<double> factors{bytes.get<double>()};
  takeRuns(bytes, own.precision(), own.size(), [&](std::size_t offset, double value) {
    positions.push_back(Index(k + 1 + offset));
    factors.push_back(value);
  });
  own.setUpperRow(k, positions, factors);
}

}  // namespace

std::shared_ptr<const SymmetricMatrix> dealRows(Processes& processes, const SymmetricMatrix& whole,
                                                const WhileWaiting& waiting) {
  std::vector<double> area(whole.area().begin(), whole.area().end());
  std::vector<Index> order(whole.order().begin(), whole.order().end());
  Precision precision = whole.precision();
  processes.broadcastArray(area, waiting);
  processes.broadcastArray(order, waiting);
  processes.broadcastValue(precision, waiting);
  const std::vector<std::size_t> starts = sharesOf(whole, std::size_t(processes.size()));
  for (int p = 1; p < processes.size(); ++p) {
    const auto share = std::size_t(p);
    sendRows(processes, p, whole, starts[share], starts[share + 1], waiting);
  }
  auto own = std::make_shared<SymmetricMatrix>(std::move(area), std::move(order), precision,
                                               whole.scratch());
  for (std::size_t k = starts[0]; k < starts[1]; ++k) {
    const SymmetricMatrix::UpperEntries row = whole.upperEntries(k);
    own->setUpperRow(k, row.positions, row.factors);
  }
  return own;
}

std::shared_ptr<const SymmetricMatrix> receiveRows(Processes& processes) {
  std::vector<double> area;
  std::vector<Index> order;
  Precision precision = Precision::single_precision;
  processes.broadcastArray(area);
  processes.broadcastArray(order);
  processes.broadcastValue(precision);
  auto own = std::make_shared<SymmetricMatrix>(std::move(area), std::move(order), precision);
  for (;;) {
    const Processes::Message message = processes.receive(0);
    if (message.bytes.empty()) return own;
    for (ByteReader bytes(message.bytes); bytes.left() > 0;) takeRow(bytes, *own);
  }
}

void evenOut(Processes& processes, SymmetricMatrix& own, const WhileWaiting& waiting) {
  const RowOwners owners = findOwners(processes, own, waiting);
  const std::vector<RowMove> moves = evenMoves(owners, processes.size());
  if (moves.empty()) return;
  std::vector<ByteWriter> sent(std::size_t(processes.size()));
  for (const RowMove& move : moves) {
    for (std::size_t k = move.first; move.from == processes.rank() && k < move.last; ++k) {
      if (owners.owner[k] != move.from) continue;
      putRow(own, k, sent[std::size_t(move.to)]);
      own.setUpperRow(k, {});
    }
  }
  std::vector<std::vector<std::byte>> messages;
  messages.reserve(sent.size());
  for (ByteWriter& rows : sent) messages.push_back(rows.take());
  for (const std::vector<std::byte>& rows : processes.exchange(std::move(messages), waiting)) {
    for (ByteReader bytes(rows); bytes.left() > 0;) takeRow(bytes, own);
  }
}

}  // namespace radiosity
