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

double Agglomeration::distance2(Index a, Index b, double bend) const {
  const Agglomerate& i = sums_[a];
  const Agglomerate& j = sums_[b];
  return square(i.moment / i.area - j.moment / j.area) +
         bend * bend * square(i.normals / i.area - j.normals / j.area);
}

float Agglomeration::cost(Index a, Index b) const {
  const double i = sums_[a].area;
  const double j = sums_[b].area;
  return float(scale_ * (i * j / (i + j)) * distance2(a, b, bend_));
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
  parallelFor(offers_.size(), 4096, [&](std::size_t k) {
    offers_[k].cost = cost(offers_[k].a, offers_[k].b);
  });
}

void Agglomeration::run(std::size_t wanted, Progress& progress) {
  renew();
  const std::greater<> last;
  std::make_heap(offers_.begin(), offers_.end(), last);
  std::size_t before = size_;
  for (std::size_t step = 1; !offers_.empty() && size_ > wanted; ++step) {
    if (step % kStepsPerCheck == 0) {
      progress.check();
      progress.advance(std::exchange(before, size_) - size_);
    }
    std::pop_heap(offers_.begin(), offers_.end(), last);
    const Offer offer = offers_.back();
    offers_.pop_back();
    Index a = parts_.find(offer.a);
    Index b = parts_.find(offer.b);
    if (a == b) continue;
    if (b < a) std::swap(a, b);
    const float now = cost(a, b);
    if (now > offer.cost) {
      offers_.push_back({now, a, b});
      std::push_heap(offers_.begin(), offers_.end(), last);
      continue;
    }
    sums_[a] += sums_[b];
    parts_.unite(a, b);
    --size_;
  }
  progress.advance(before - size_);
}

}  // namespace radiosity
