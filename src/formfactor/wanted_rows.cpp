#include "formfactor/wanted_rows.h"

#include <cmath>
#include <utility>

namespace radiosity {

WantedRows::WantedRows(std::size_t patches, std::span<const Index> wanted)
    : which_(patches, kNone),
      exchange_(wanted.size() * patches, 0.0),
      squares_(exchange_.size(), 0.0),
      rows_(wanted.size()) {
  for (Index w = 0; w < wanted.size(); ++w) {
    which_[wanted[w]] = w;
    rows_[w].patch = wanted[w];
  }
}

void WantedRows::add(Index a, Index b, double exchange, double error) {
  addFrom(a, b, exchange, error);
  addFrom(b, a, exchange, error);
}

void WantedRows::addBacks(Index patch, std::span<const SeenBack> seen) {
  if (which_[patch] == kNone) return;
  for (const SeenBack& back : seen) addBack(back, rows_[which_[patch]].backs);
}

std::vector<KnownRow> WantedRows::take() {
  const std::size_t patches = which_.size();
  for (std::size_t w = 0; w < rows_.size(); ++w) {
    for (Index i = 0; i < patches; ++i) {
      const double exchange = exchange_[w * patches + i];
      if (!(exchange > 0)) continue;
      rows_[w].entries.push_back({i, exchange, std::sqrt(squares_[w * patches + i])});
    }
  }
  return std::move(rows_);
}

void WantedRows::addFrom(Index from, Index to, double exchange, double error) {
  if (which_[from] == kNone) return;
  const std::size_t k = which_[from] * which_.size() + to;
  exchange_[k] += exchange;
  squares_[k] += error * error;
}

}  // namespace radiosity
