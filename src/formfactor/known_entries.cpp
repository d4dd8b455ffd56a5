#include "formfactor/known_entries.h"

#include <algorithm>
#include <utility>

#include "base/hash.h"

namespace radiosity {

namespace {

/// Rounding, and faces that nearly meet, may leave more than the whole view.
void limitBacks(std::vector<SeenBack>& backs) {
  double sum = 0;
  for (const SeenBack& back : backs) sum += back.share;
  if (sum <= 1) return;
  for (SeenBack& back : backs) back.share /= sum;
}

}  // namespace

KnownEntries::KnownEntries(std::vector<KnownRow> rows, std::span<const Index> position)
    : rows_(std::move(rows)) {
  if (rows_.empty()) return;
  row_at_.assign(position.size(), kNone);
  entries_.resize(position.size());
  for (Index r = 0; r < rows_.size(); ++r) {
    row_at_[position[rows_[r].patch]] = r;
    limitBacks(rows_[r].backs);
  }
  for (const KnownRow& row : rows_) {
    const Index own = position[row.patch];
    for (const auto& [patch, exchange, error] : row.entries) {
      const Index other = position[patch];
      entries_[own].push_back({other, exchange, error});
      if (row_at_[other] == kNone) entries_[other].push_back({own, exchange, error});
    }
  }
  for (std::vector<Entry>& entries : entries_) {
    std::sort(entries.begin(), entries.end(),
              [](const Entry& a, const Entry& b) { return a.position < b.position; });
  }
}

double KnownEntries::share(std::size_t position, double area) const {
  double sum = 0;
  for (const Entry& entry : at(position)) sum += entry.exchange / area;
  return sum;
}

RowAccount KnownEntries::account(std::size_t position, double area, bool closed) const {
  RowAccount account;
  for (const SeenBack& back : rowAt(position)->backs) account.backs += back.share;
  const double rest = std::max(0.0, 1 - account.backs);
  account.fronts = closed ? rest : std::min(rest, share(position, area));
  account.sky = rest - account.fronts;
  return account;
}

std::uint64_t KnownEntries::identity() const {
  Hash hash;
  for (const KnownRow& row : rows_) {
    hash.bytes(&row.patch, sizeof row.patch);
    for (const KnownExchange& entry : row.entries) {
      hash.bytes(&entry.exchange, sizeof entry.exchange);
    }
  }
  return hash.value();
}

}  // namespace radiosity
