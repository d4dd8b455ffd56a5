#include "matrix/shared_rows.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/byte_stream.h"
#include "base/made.h"
#include "base/parallel.h"
#include "base/union_find.h"
#include "matrix/ordered_sums.h"
#include "matrix/own_rows.h"
#include "matrix/row_parts.h"
#include "matrix/run_row.h"

namespace radiosity {

namespace {

enum class Request : std::uint32_t {
  product,
  row_sums,
  row_entries,
  bytes,
  panel,
  deal,
  deal_round,
  deal_end,
  columns,
  rooms,
  solve,
  forget
};

struct Order {
  Request request = Request::forget;
  std::int32_t bands = 1;
  std::uint64_t first = 0;
  std::uint64_t last = 0;
};

/// Integers, which sums of doubles keep exactly.
std::vector<double> rowEntriesOf(const ExchangeMatrix& own) {
  const std::vector<Index> entries = own.rowEntries();
  return {entries.begin(), entries.end()};
}

/// By position: the first position of the component that these rows join it to.
std::vector<Index> joinedByOwn(const ExchangeMatrix& own) {
  return joinedBy(dynamic_cast<const SymmetricMatrix&>(own));
}

/// The part of a problem that process 0 sends to all, joined with the parts of this process.
class SharedProblem {
 public:
  SharedProblem(Processes& processes, const ExchangeMatrix& own, const KrylovProblem& given,
                const WhileWaiting& waiting)
      : left_(given.left.begin(), given.left.end()),
        right_(given.right.begin(), given.right.end()),
        right_side_(given.right_side.begin(), given.right_side.end()),
        near_null_(given.near_null.begin(), given.near_null.end()),
        near_null_of_(given.near_null_of.begin(), given.near_null_of.end()) {
    struct {
      std::uint64_t near_nulls;
      double reduction;
      std::int32_t bands;
      std::int32_t most_products;
      bool symmetric;
    } figures{given.near_nulls, given.reduction, given.bands, given.most_products, given.symmetric};
    processes.broadcastValue(figures, waiting);
    for (std::vector<double>* values : {&left_, &right_, &right_side_, &near_null_}) {
      processes.broadcastArray(*values, waiting);
    }
    processes.broadcastArray(near_null_of_, waiting);
    problem_.rows = own.size();
    problem_.bands = figures.bands;
    problem_.left = left_;
    problem_.right = right_;
    problem_.right_side = right_side_;
    problem_.symmetric = figures.symmetric;
    problem_.near_null = near_null_;
    problem_.near_null_of = near_null_of_;
    problem_.near_nulls = figures.near_nulls;
    problem_.reduction = figures.reduction;
    problem_.most_products = figures.most_products;
    const int bands = figures.bands;
    problem_.product = [&own, bands](std::span<const double> x, std::span<double> y) {
      own.product(x, bands, y);
    };
    problem_.transposed_product = [&own, bands](std::span<const double> x, std::span<double> y) {
      transposedProduct(own, x, bands, y);
    };
    problem_.entries = [&own](const KrylovProblem::Visit& visit) { forOwnEntries(own, visit); };
  }

  const KrylovProblem& problem() const { return problem_; }

 private:
  std::vector<double> left_;
  std::vector<double> right_;
  std::vector<double> right_side_;
  std::vector<double> near_null_;
  std::vector<unsigned> near_null_of_;
  KrylovProblem problem_;
};

}  // namespace

SharedRows::SharedRows(Processes& processes, std::shared_ptr<const ExchangeMatrix> own,
                       WhileWaiting waiting)
    : ExchangeMatrix({own->area().begin(), own->area().end()}, own->isSymmetric(),
                     {own->order().begin(), own->order().end()}, own->precision()),
      processes_(processes),
      own_(std::move(own)),
      waiting_(std::move(waiting)),
      owners_(findOwners(processes_, *own_, waiting_)) {}

SharedRows::~SharedRows() {
  if (processes_.halfDone()) return;
  Order order;
  processes_.broadcastValue(order);
}

void SharedRows::multiply(std::span<const double> x, int bands, std::span<double> y,
                          std::span<const std::uint8_t> wanted) const {
  const SharedStep step(processes_);
  Order order{.request = Request::product, .bands = bands};
  processes_.broadcastValue(order, waiting_);
  std::vector<double> sums(x.begin(), x.end());
  processes_.broadcast(std::as_writable_bytes(std::span(sums)), waiting_);
  own_->product(x, bands, sums);
  processes_.sum(sums, waiting_);
  const auto width = std::size_t(bands);
  for (std::size_t i = 0; i < size(); ++i) {
    if (!wanted.empty() && wanted[i] == 0) continue;
    std::copy_n(&sums[i * width], width, &y[i * width]);
  }
}

std::vector<double> SharedRows::rowSums() const {
  const SharedStep step(processes_);
  Order order{.request = Request::row_sums};
  processes_.broadcastValue(order, waiting_);
  return orderedRowSums(processes_, *own_, owners_, waiting_);
}

std::vector<Index> SharedRows::rowEntries() const {
  const SharedStep step(processes_);
  Order order{.request = Request::row_entries};
  processes_.broadcastValue(order, waiting_);
  std::vector<double> sums = rowEntriesOf(*own_);
  processes_.sum(sums, waiting_);
  return {sums.begin(), sums.end()};
}

std::size_t SharedRows::bytes() const {
  const SharedStep step(processes_);
  Order order{.request = Request::bytes};
  processes_.broadcastValue(order, waiting_);
  auto sum = double(own_->bytes());
  processes_.sum({&sum, 1}, waiting_);
  return std::size_t(sum);
}

std::size_t SharedRows::panelEntries() const {
  return panelBytes(bytes() / std::size_t(processes())) / RowPanel::kEntryBytes;
}

void SharedRows::readRows(std::size_t first, std::size_t last, std::span<const Index> /*entries*/,
                          CompressedRows& rows) const {
  const SharedStep step(processes_);
  Order order{.request = Request::panel, .first = first, .last = last};
  processes_.broadcastValue(order, waiting_);
  std::vector<RowsPart> parts{partOf(*own_, {first, last})};
  for (int p = 1; p < processes_.size(); ++p) {
    parts.push_back(partFrom(processes_.receive(p, waiting_).bytes));
  }
  mergeParts(parts, size(), rows);
}

void SharedRows::deal(DealtBlocks blocks, const MakeTaker& make_taker, Progress& progress) const {
  std::optional<Dealing> dealing;
  std::size_t rounds = 0;
  {
    const SharedStep step(processes_);
    Order order{.request = Request::deal};
    processes_.broadcastValue(order, waiting_);
    blocks.send(processes_, waiting_);
    dealing.emplace(processes_, *own_, std::move(blocks), make_taker);
    rounds = dealing->rounds();
  }
  for (std::size_t round = 0; round <= rounds; ++round) {
    progress.check();
    std::string problem;
    {
      const SharedStep step(processes_);
      Order order{.request = round < rounds ? Request::deal_round : Request::deal_end,
                  .first = round};
      processes_.broadcastValue(order, waiting_);
      problem = round < rounds ? dealing->round(round, waiting_) : dealing->end(waiting_);
    }
    if (!problem.empty()) throw RunError(problem);
    if (round < rounds) progress.advance(dealing->rowsDone(round + 1) - dealing->rowsDone(round));
  }
}

void SharedRows::columns(std::size_t first, std::size_t last, std::span<double> values) const {
  const SharedStep step(processes_);
  Order order{.request = Request::columns, .first = first, .last = last};
  processes_.broadcastValue(order, waiting_);
  own_->columns(first, last, values);
  processes_.sum(values, waiting_);
}

SharedRows::Rooms SharedRows::rooms() const {
  if (!isSymmetric()) return ExchangeMatrix::rooms();
  const SharedStep step(processes_);
  Order order{.request = Request::rooms};
  processes_.broadcastValue(order, waiting_);
  UnionFind sets(size());
  std::vector<Index> first = joinedByOwn(*own_);
  for (int p = 0;;) {
    for (std::size_t k = 0; k < first.size(); ++k) sets.unite(first[k], Index(k));
    if (++p == processes_.size()) break;
    const Processes::Message message = processes_.receive(p, waiting_);
    ByteReader bytes(message.bytes);
    first = bytes.getArray<Index>();
  }
  for (std::size_t k = 0; k < first.size(); ++k) first[k] = sets.find(Index(k));
  return roomsOf(first, ExchangeMatrix::order());
}

KrylovOutcome SharedRows::solve(const KrylovProblem& problem, std::span<double> solution) const {
  const SharedStep step(processes_);
  Order order{.request = Request::solve};
  processes_.broadcastValue(order, waiting_);
  const SharedProblem shared(processes_, *own_, problem, waiting_);
  return processes_.solve(shared.problem(), solution);
}

std::shared_ptr<const ExchangeMatrix> wholeMatrix(Processes* processes,
                                                  std::shared_ptr<const ExchangeMatrix> own,
                                                  WhileWaiting waiting) {
  if (processes == nullptr) return own;
  return std::make_shared<SharedRows>(*processes, std::move(own), std::move(waiting));
}

void serveRows(Processes& processes, const ExchangeMatrix& own, const MakeTaker& make_taker) {
  const RowOwners owners = findOwners(processes, own, {});
  std::optional<Dealing> dealing;
  std::vector<double> values;
  for (Order order;;) {
    processes.broadcastValue(order);
    switch (order.request) {
      case Request::product: {
        std::vector<double> x(own.size() * std::size_t(order.bands));
        processes.broadcast(std::as_writable_bytes(std::span(x)));
        values.assign(x.size(), 0.0);
        own.product(x, order.bands, values);
        processes.sum(values);
        break;
      }
      case Request::row_sums:
        orderedRowSums(processes, own, owners, {});
        break;
      case Request::row_entries:
        values = rowEntriesOf(own);
        processes.sum(values);
        break;
      case Request::bytes:
        values.assign(1, double(own.bytes()));
        processes.sum(values);
        break;
      case Request::panel:
        processes.send(0, bytesOf(partOf(own, {order.first, order.last})));
        break;
      case Request::deal:
        dealing.emplace(processes, own, DealtBlocks::receive(processes), make_taker);
        break;
      case Request::deal_round:
        made(dealing).round(order.first, {});
        break;
      case Request::deal_end:
        made(dealing).end({});
        dealing.reset();
        break;
      case Request::columns:
        values.assign((order.last - order.first) * own.size(), 0.0);
        own.columns(order.first, order.last, values);
        processes.sum(values);
        break;
      case Request::rooms: {
        ByteWriter bytes;
        const std::vector<Index> first = joinedByOwn(own);
        bytes.putArray(std::span(first));
        processes.send(0, bytes.bytes());
        break;
      }
      case Request::solve: {
        const SharedProblem shared(processes, own, {}, {});
        processes.solve(shared.problem(), {});
        break;
      }
      case Request::forget:
        return;
    }
  }
}

}  // namespace radiosity
