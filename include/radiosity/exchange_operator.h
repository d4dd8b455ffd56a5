// What solvers ask of form factors, however these are held. It knows no geometry.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "radiosity/base.h"

namespace [[gnu::visibility("default")]] radiosity {

/// Of stored form factors; all sums have 64 bits.
enum class Precision { single_precision, double_precision };

/// Form factors F of N patches, N x N, and the patches' areas; G_ij = A_i F_ij is the exchange
/// area. Most are an ExchangeMatrix, which stores a value a pair (exchange_matrix.h).
class ExchangeOperator {
 public:
  virtual ~ExchangeOperator() = default;
  ExchangeOperator(const ExchangeOperator&) = delete;
  ExchangeOperator& operator=(const ExchangeOperator&) = delete;
  ExchangeOperator& operator=(ExchangeOperator&&) = delete;

  std::size_t size() const { return area_.size(); }
  std::span<const double> area() const { return area_; }
  /// Whether A_i F_ij = A_j F_ji by construction.
  bool isSymmetric() const { return symmetric_; }

  /// y = F x for all bands in one pass, in parallel, with the same bits for any thread count. x, y:
  /// N * bands, row-major, not aliased. `wanted`: N flags of the rows to compute; others of y stay
  /// as they are. Empty: all.
  void product(std::span<const double> x, int bands, std::span<double> y,
               std::span<const std::uint8_t> wanted = {}) const {
    multiply(x, bands, y, wanted);
  }
  virtual std::vector<double> rowSums() const;               ///< N
  virtual std::vector<double> row(std::size_t i) const = 0;  ///< N values
  virtual double at(std::size_t i, std::size_t j) const;     ///< F_ij
  virtual std::vector<double> dense() const;                 ///< N x N, row-major
  /// Whether no F_ij is below 0, as it is of all but fits to the light of many patches at once.
  virtual bool isNonNegative() const { return true; }
  /// sum_j |F_ij|, or a bound of it: N.
  virtual std::vector<double> rowNorms() const { return rowSums(); }
  /// About the relative error (L2, by area) of F x, N * bands, where the operator knows it of a
  /// field; nothing if it does not, or if F x is 0.
  virtual std::optional<double> relativeError(std::span<const double> /*x*/, int /*bands*/) const {
    return std::nullopt;
  }

  /// Whether sweep() works.
  virtual bool sweeps() const { return false; }
  /// Calls update(i, gathered) for each row, one after the other, with gathered[b] =
  /// sum_j F_ij x[j * bands + b], where x includes the updates so far. An update may change x of
  /// patch i and of no other. Rows that are not `wanted` are skipped. On one thread.
  using Update = std::function<void(std::size_t i, const double* gathered)>;
  virtual void sweep(std::span<double> x, int bands, const Update& update,
                     std::span<const std::uint8_t> wanted) const;

  /// Sets of patches that exchange no light with others: the room of each patch, from 0.
  struct Rooms {
    std::vector<Index> of_patch;  ///< N
    std::size_t count = 0;
  };
  /// Symmetric: the rooms, as far as they are known; here, one of all patches.
  virtual Rooms rooms() const;

  virtual std::size_t bytes() const = 0;  ///< that it takes, without areas

 protected:
  /// `area`: finite values >= 0, m^2, else InputError.
  ExchangeOperator(std::vector<double> area, bool symmetric);
  ExchangeOperator(ExchangeOperator&&) noexcept = default;

 private:
  virtual void multiply(std::span<const double> x, int bands, std::span<double> y,
                        std::span<const std::uint8_t> wanted) const = 0;

  std::vector<double> area_;
  bool symmetric_;
};

}  // namespace radiosity
