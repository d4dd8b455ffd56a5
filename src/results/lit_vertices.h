// Numbers the corners of lit triangles as vertices.
#pragma once

#include <array>
#include <unordered_map>
#include <utility>
#include <vector>

#include "results/lit_triangles.h"

namespace radiosity {

/// Corners at one point with the same radiosity are one vertex. If values differ (at a crease),
/// there is one vertex for each value.
class LitVertices {
 public:
  using Triple = std::array<float, 3>;

  /// The corner's vertex, and whether it is new: then it is the last. `may_be(k)`: whether the
  /// corner may be vertex k, of the same point and radiosity.
  template <class MayBe>
  std::pair<Index, bool> of(const LitCorner& corner, const MayBe& may_be) {
    const Vec3& b = corner.radiosity;
    const Triple value = {float(b.x), float(b.y), float(b.z)};
    std::vector<Index>& known = at_point_[corner.point];
    for (const Index k : known) {
      if (radiosity_[k] == value && may_be(k)) return {k, false};
    }
    known.push_back(add(value));
    return {known.back(), true};
  }
  std::pair<Index, bool> of(const LitCorner& corner) {
    return of(corner, [](Index) { return true; });
  }

  /// A vertex that corners do not share.
  Index add(const Triple& radiosity) {
    radiosity_.push_back(radiosity);
    return Index(radiosity_.size() - 1);
  }

  const std::vector<Triple>& radiosity() const { return radiosity_; }  ///< W/m^2

 private:
  std::vector<Triple> radiosity_;
  std::unordered_map<Index, std::vector<Index>> at_point_;
};

}  // namespace radiosity
