#include "radiosity/exchange_operator.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <utility>

namespace radiosity {

ExchangeOperator::ExchangeOperator(std::vector<double> area, bool symmetric)
    : area_(std::move(area)), symmetric_(symmetric) {
  for (std::size_t i = 0; i < area_.size(); ++i) {
    if (!(area_[i] >= 0) || !std::isfinite(area_[i])) {
      throw InputError(fmt::format("exchange matrix: {} is not the area of patch {}", area_[i], i));
    }
  }
}

std::vector<double> ExchangeOperator::rowSums() const {
  const std::vector<double> ones(size(), 1.0);
  std::vector<double> sums(size());
  product(ones, 1, sums);
  return sums;
}

double ExchangeOperator::at(std::size_t i, std::size_t j) const { return row(i)[j]; }

std::vector<double> ExchangeOperator::dense() const {
  std::vector<double> values;
  values.reserve(size() * size());
  for (std::size_t i = 0; i < size(); ++i) {
    const std::vector<double> of_row = row(i);
    values.insert(values.end(), of_row.begin(), of_row.end());
  }
  return values;
}

void ExchangeOperator::sweep(std::span<double> /*x*/, int /*bands*/, const Update& /*update*/,
                             std::span<const std::uint8_t> /*wanted*/) const {
  throw std::logic_error("a sweep over form factors that have none");
}

ExchangeOperator::Rooms ExchangeOperator::rooms() const {
  return {std::vector<Index>(size(), 0), size() > 0 ? std::size_t(1) : 0};
}

}  // namespace radiosity
