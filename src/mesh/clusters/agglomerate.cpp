#include "mesh/clusters/agglomerate.h"

#include <algorithm>
#include <functional>
#include <glm/geometric.hpp>
#include <utility>

#include "base/parallel.h"

namespace radiosity {

namespace {

constexpr std::size_t kStepsPerCheck = 4096;

double square(const Vec3& v) { return glm::dot(v, v); }

}  // namespace

Agglomeration::Agglomeration(std::vector<Agglomerate> pieces, double bend, double unit)
    : sums_(std::move(pieces)),
      parts_(sums_.size()),
      bend_(bend),
      scale_(1 / (unit * unit * unit * unit)),
      size_(sums_.size()) {}

float Agglomeration::cost(Index a, Index b) const {
  const Agglomerate& i = sums_[a];
  const Agglomerate& j = sums_[b];
  const double distance2 = square(i.moment / i.area - j.moment / j.area) +
                           bend_ * bend_ * square(i.normals / i.area - j.normals / j.area);
  return float(scale_ * (i.area * j.area / (i.area + j.area)) * distance2);
}

void Agglomeration::join(Index a, Index b) {
  a = parts_.find(a);
  b = parts_.find(b);
  if (a == b) return;
  if (b < a) std::swap(a, b);
  sums_[a] += sums_[b];
  parts_.unite(a, b);
  --size_;
}

void Agglomeration::offer(Index a, Index b) {
  a = parts_.find(a);
  b = parts_.find(b);
  if (b < a) std::swap(a, b);
  if (a != b) offers_.push_back({cost(a, b), a, b});
}

void Agglomeration::renew() {
  for (Offer& offer : offers_) {
    offer.a = parts_.find(offer.a);
    offer.b = parts_.find(offer.b);
    if (offer.b < offer.a) std::swap(offer.a, offer.b);
  }
  const auto pairOf = [](const Offer& offer) { return std::pair(offer.a, offer.b); };
  std::erase_if(offers_, [](const Offer& offer) { return offer.a == offer.b; });
  // Offers of one pair may change places: they get the same cost below.
  parallelSort(offers_, [&](const Offer& x, const Offer& y) { return pairOf(x) < pairOf(y); });
  const auto [first, last] = std::ranges::unique(offers_, {}, pairOf);
  offers_.erase(first, last);
  parallelFor(offers_.size(), 4096,
              [&](std::size_t k) { offers_[k].cost = cost(offers_[k].a, offers_[k].b); });
}

/// The cheapest of the sorted offers from `next` on and of a heap of those that have become dearer,
/// which leaves its list.
Agglomeration::Offer Agglomeration::takeCheapest(std::size_t& next, std::vector<Offer>& dearer) {
  if (dearer.empty() || (next < offers_.size() && dearer.front() > offers_[next])) {
    return offers_[next++];
  }
  std::pop_heap(dearer.begin(), dearer.end(), std::greater<>());
  const Offer offer = dearer.back();
  dearer.pop_back();
  return offer;
}

void Agglomeration::run(std::size_t wanted, Progress& progress) {
  renew();
  // Most offers are taken in the order of their sorting; a heap of all would be slower.
  parallelSort(offers_, [](const Offer& x, const Offer& y) { return y > x; });
  std::size_t next = 0;
  std::vector<Offer> dearer;
  std::size_t before = size_;
  for (std::size_t step = 1; size_ > wanted; ++step) {
    if (next == offers_.size() && dearer.empty()) break;
    if (step % kStepsPerCheck == 0) {
      progress.check();
      progress.advance(std::exchange(before, size_) - size_);
    }
    const Offer offer = takeCheapest(next, dearer);
    Index a = parts_.find(offer.a);
    Index b = parts_.find(offer.b);
    if (a == b) continue;
    if (b < a) std::swap(a, b);
    const float now = cost(a, b);
    if (now > offer.cost) {
      dearer.push_back({now, a, b});
      std::push_heap(dearer.begin(), dearer.end(), std::greater<>());
      continue;
    }
    join(a, b);
  }
  offers_.erase(offers_.begin(), offers_.begin() + std::ptrdiff_t(next));
  offers_.insert(offers_.end(), dearer.begin(), dearer.end());
  progress.advance(before - size_);
}

}  // namespace radiosity
