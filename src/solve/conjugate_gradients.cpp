// Conjugate gradients on the symmetric form of B = E + rho F B, for all bands in one pass.
//
// With H = F B, A the areas, G = A F symmetric and D = sqrt(rho), let z = D sqrt(A) H. Then
//     (I - D S D) z = D sqrt(A) F E,     S = A^-1/2 G A^-1/2 = sqrt(A) F A^-1/2,
// The system is symmetric, free of 1 / rho, and positive definite where the spectral radius of
// rho F is below 1; B = E + D A^-1/2 z. (Hestenes & Stiefel, J. Res. NBS 49, 1952.)
//
// The overall brightness of each closed room converges slowly: its eigenvalue is about 1 - rho,
// while all others are near 1. We solve for that vector, w = D sqrt(A) in a room, exactly and keep
// it out of the iteration (deflation: Nicolaides, SIAM J. Numer. Anal. 24, 1987; Saad, Yeung, Erhel
// & Guyomarc'h, SIAM J. Sci. Comput. 21, 2000). Rooms are the connected components of the matrix:
// they exchange no light, so one product serves them all and their coarse matrix is diagonal.
#include <algorithm>
#include <limits>
#include <utility>

#include "solve/iteration.h"

namespace radiosity {

namespace {

/// A cycle ends once it has reduced the 2-norm of its residual by this factor: beyond, the
/// recurrence may have drifted from the true residual, with which the next cycle begins.
constexpr double kCycleReduction = 1e-10;
/// If w . (I - D S D) w is below this share of w . w, the room neither absorbs nor lets out light.
/// Such a room is dark (findWhiteRoom()), so there is nothing to solve for.
constexpr double kNothingLeft = 1e-13;
/// The least mean reflectance, by area, at which deflation pays. A scene below it in every band
/// converges as quickly without.
constexpr double kBright = 0.7;

class ConjugateGradients {
 public:
  ConjugateGradients(const System& system, Convergence& convergence)
      : system_(system),
        convergence_(convergence),
        largest_(largestEmission(system)),
        bands_(std::size_t(system.bands)),
        up_(Eigen::Index(system.matrix.size()), system.bands),
        down_(up_.rows(), up_.cols()),
        z_(BandArray::Zero(up_.rows(), up_.cols())),
        fields_{system.emission, std::vector<double>(system.emission.size())},
        scratch_{fields_.radiosity, fields_.irradiance} {
    symmetricScales(system, {up_.data(), std::size_t(up_.size())},
                    {down_.data(), std::size_t(down_.size())});
  }

  Fields run() {
    auto radiosity = asArray(fields_.radiosity, system_.bands);
    const auto irradiance = asArray(fields_.irradiance, system_.bands);
    const auto emission = asArray(system_.emission, system_.bands);
    Corrections corrections(system_, convergence_);
    for (bool first = true;; first = false) {
      radiosity = emission + down_ * z_;
      if (corrections.end(fields_, indefinite_)) return std::move(fields_);
      if (first) findRooms();
      if (!indefinite_) cycle(up_ * irradiance - z_);
      // H is not below 0 where no E is.
      if (system_.nonnegative) z_ = z_.max(0.0);
    }
  }

 private:
  using Sums = std::vector<double>;  // one value for each band, or for each room and band

  /// Calls visit(patch, band, index of their value in an array), always in the same order.
  template <class Visit>
  void forAll(const Visit& visit) const {
    const std::size_t n = system_.matrix.size();
    for (std::size_t i = 0, k = 0; i < n; ++i) {
      for (std::size_t b = 0; b < bands_; ++b, ++k) visit(i, b, k);
    }
  }

  /// (I - D S D) p.
  BandArray apply(const BandArray& p) {
    asArray(scratch_.radiosity, system_.bands) = down_ * p;
    multiply(system_, scratch_, convergence_);
    return p - up_ * asArray(scratch_.irradiance, system_.bands);
  }

  /// The sum of a * b of each band.
  Sums dots(const BandArray& a, const BandArray& b) const {
    Sums sums(bands_, 0.0);
    forAll([&](std::size_t /*patch*/, std::size_t band, std::size_t k) {
      sums[band] += a.data()[k] * b.data()[k];
    });
    return sums;
  }

  /// The same of each room: room * bands + band.
  Sums roomDots(const BandArray& a, const BandArray& b) const {
    Sums sums(rooms_.count * bands_, 0.0);
    forAll([&](std::size_t i, std::size_t band, std::size_t k) {
      sums[rooms_.of_patch[i] * bands_ + band] += a.data()[k] * b.data()[k];
    });
    return sums;
  }

  /// Finds the rooms, the image of their w under I - D S D, and the coarse matrix.
  void findRooms() {
    if (convergence_.sweeps() < 1 || convergence_.lastSweep() || !anyBright()) return;
    rooms_ = system_.matrix.rooms();
    image_ = apply(up_);
    convergence_.record(convergence_.history().back());
    coarse_ = roomDots(up_, image_);
    const Sums whole = roomDots(up_, up_);
    const auto emission = asArray(system_.emission, system_.bands);
    const Sums lit = roomDots(emission, emission);
    for (std::size_t k = 0; k < coarse_.size(); ++k) {
      // A dark room stays dark, also a white one whose rows sum to a rounding more than 1.
      if (!(lit[k] > 0)) {
        coarse_[k] = 0;
        continue;
      }
      if (coarse_[k] < -kNothingLeft * whole[k]) indefinite_ = true;
      coarse_[k] = coarse_[k] > kNothingLeft * whole[k] ? 1 / coarse_[k] : 0.0;
    }
  }

  bool anyBright() const {
    Sums area(bands_, 0.0);
    Sums reflecting(bands_, 0.0);
    forAll([&](std::size_t i, std::size_t band, std::size_t k) {
      area[band] += system_.matrix.area()[i];
      reflecting[band] += up_.data()[k] * up_.data()[k];
    });
    for (std::size_t b = 0; b < bands_; ++b) {
      if (reflecting[b] > kBright * area[b]) return true;
    }
    return false;
  }

  /// target += sign * vector * c of its room and band.
  void addRooms(BandArray& target, double sign, const BandArray& vector, const Sums& c) const {
    forAll([&](std::size_t i, std::size_t band, std::size_t k) {
      target.data()[k] += sign * c[rooms_.of_patch[i] * bands_ + band] * vector.data()[k];
    });
  }

  /// The coefficient of each room's w: (dual . v) / (w . (I - D S D) w).
  Sums roomShares(const BandArray& dual, const BandArray& v) const {
    Sums shares = roomDots(dual, v);
    for (std::size_t k = 0; k < shares.size(); ++k) shares[k] *= coarse_[k];
    return shares;
  }

  bool deflates() const { return rooms_.count > 0; }

  /// The part of a residual that is conjugate to every w: it gives the next direction.
  BandArray withoutRooms(const BandArray& residual) const {
    BandArray p = residual;
    if (deflates()) addRooms(p, -1, up_, roomShares(image_, residual));
    return p;
  }

  /// Iterates from z, whose true residual is `r`, until the recurrence predicts convergence. Leaves
  /// one product for the check of the true residual.
  void cycle(BandArray r) {
    if (deflates()) {
      const Sums shares = roomShares(up_, r);
      addRooms(z_, 1, up_, shares);
      addRooms(r, -1, image_, shares);
    }
    BandArray p = withoutRooms(r);
    Sums left = dots(r, r);
    const Sums start = left;
    while (!convergence_.lastSweep() && !enough(r) && !allSmall(left, start)) {
      const BandArray q = apply(p);
      const Sums curvature = dots(p, q);
      Sums step(bands_, 0.0);
      for (std::size_t b = 0; b < bands_; ++b) {
        if (!(left[b] > smallest(start[b]))) continue;
        indefinite_ = indefinite_ || !(curvature[b] > 0);
        if (!indefinite_) step[b] = left[b] / curvature[b];
      }
      addScaled(z_, step, p);
      for (double& s : step) s = -s;
      addScaled(r, step, q);
      convergence_.record(foreseen(r));
      if (indefinite_) return;
      const Sums next = dots(r, r);
      Sums growth(bands_, 0.0);
      for (std::size_t b = 0; b < bands_; ++b) {
        if (left[b] > smallest(start[b])) growth[b] = next[b] / left[b];
      }
      left = next;
      BandArray fresh = withoutRooms(r);
      addScaled(fresh, growth, p);
      p = std::move(fresh);
    }
  }

  /// target += vector * factor of each band.
  void addScaled(BandArray& target, const Sums& factor, const BandArray& vector) const {
    forAll([&](std::size_t /*patch*/, std::size_t band, std::size_t k) {
      target.data()[k] += factor[band] * vector.data()[k];
    });
  }

  static double smallest(double start) { return kCycleReduction * kCycleReduction * start; }
  static bool allSmall(const Sums& left, const Sums& start) {
    for (std::size_t b = 0; b < left.size(); ++b) {
      if (left[b] > smallest(start[b])) return false;
    }
    return true;
  }

  /// The relative residual of B that the recurrence predicts; D A^-1/2 r is the residual of B.
  double foreseen(const BandArray& r) const {
    const Eigen::ArrayXd most = (down_ * r).abs().colwise().maxCoeff();
    return (most / largest_).maxCoeff();
  }

  /// Whether the predicted residual is within half the tolerance, for every patch.
  bool enough(const BandArray& r) const {
    const double tolerance = 0.5 * convergence_.tolerance();
    if (foreseen(r) > tolerance) return false;
    if (!system_.nonnegative) return true;
    const BandArray own = asArray(system_.emission, system_.bands) + down_ * z_;
    return ((down_ * r).abs().rowwise() - (kOwnRounding * largest_).transpose() <=
            kOwnShare * tolerance * own)
        .all();
  }

  const System& system_;
  Convergence& convergence_;
  Eigen::ArrayXd largest_;
  std::size_t bands_;
  BandArray up_;    // D sqrt(A): also w, in every room
  BandArray down_;  // D A^-1/2
  BandArray z_;
  Fields fields_;
  Fields scratch_;
  ExchangeOperator::Rooms rooms_;  // none: nothing is deflated
  BandArray image_;                // (I - D S D) w
  Sums coarse_;                    // 1 over w . (I - D S D) w, by room and band; 0: left out
  bool indefinite_ = false;
};

}  // namespace

Fields conjugateGradients(const System& system, Convergence& convergence) {
  return ConjugateGradients(system, convergence).run();
}

}  // namespace radiosity
