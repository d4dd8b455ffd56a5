// A convex polygon without convex shadows, in its plane.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// A side of a shadow in the plane it falls on: a u + b v + c >= 0 inside.
struct ShadowSide {
  double a = 0, b = 0, c = 0;
};

/// Cuts shadows out of a polygon, one after the other; the rest is a list of disjoint convex
/// pieces. A walk along the border of the shadows' union would make fewer cuts, but each of its
/// decisions must agree with others. Here, where borders nearly coincide, as those of books side by
/// side do, either decision moves a sliver. Holds scratch memory.
class VisiblePieces {
 public:
  /// Convex, three corners or more.
  void begin(std::span<const Vec2> polygon);

  /// Takes one shadow away: the part inside all `sides`. A piece that passes a side by no more than
  /// `noise` is not cut by it. Taking large shadows first leaves the least for the others to cut.
  /// False if all of the shadow falls on parts that are hidden already.
  bool subtract(std::span<const ShadowSide> sides, double noise);

  bool empty() const { return pieces_.empty(); }

  /// Calls visit(from, to) for every edge of every piece; pieces turn as the polygon does.
  template <class Visit>
  void forEdges(const Visit& visit) const {
    for (const Piece& piece : pieces_) {
      const Vec2* const corner = &corners_[piece.first];
      const Vec2* from = corner + piece.count - 1;
      for (const Vec2* to = corner; to != corner + piece.count; from = to++) visit(*from, *to);
    }
  }

 private:
  struct Piece {
    std::uint32_t first = 0;  ///< into corners_
    std::uint32_t count = 0;
    Vec2 low{0.0}, high{0.0};  ///< a box around it
  };
  enum class Side : std::uint8_t { inside, outside, across };

  Side sideOf(const Piece& piece, const ShadowSide& side, double noise);
  bool mayMeet(const Piece& piece, std::span<const ShadowSide> sides, double noise);
  bool cutOut(Piece piece, double noise);
  Piece part(const Piece& piece, bool inside);
  Piece boxed(std::size_t first) const;

  std::vector<Vec2> corners_;  ///< of all pieces there were
  std::vector<Piece> pieces_;
  std::vector<Piece> cut_off_;  ///< by the sides of the shadow at work
  std::vector<const ShadowSide*> cutting_;
  std::vector<double> heights_;  ///< of a piece's corners over the side last looked at
};

}  // namespace radiosity
