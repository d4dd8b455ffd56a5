#include "formfactor/exact/occluded/visible_pieces.h"

#include <algorithm>
#include <glm/common.hpp>

namespace radiosity {

/// The piece of the corners from `first` on.
VisiblePieces::Piece VisiblePieces::boxed(std::size_t first) const {
  Piece piece{std::uint32_t(first), std::uint32_t(corners_.size() - first), corners_[first],
              corners_[first]};
  for (std::size_t k = first + 1; k < corners_.size(); ++k) {
    piece.low = glm::min(piece.low, corners_[k]);
    piece.high = glm::max(piece.high, corners_[k]);
  }
  return piece;
}

void VisiblePieces::begin(std::span<const Vec2> polygon) {
  corners_.assign(polygon.begin(), polygon.end());
  pieces_.assign(1, boxed(0));
}

/// Leaves the corners' heights in heights_.
VisiblePieces::Side VisiblePieces::sideOf(const Piece& piece, const ShadowSide& side,
                                          double noise) {
  if (heights_.size() < piece.count) heights_.resize(2 * piece.count);
  const Vec2* const corner = &corners_[piece.first];
  double least = side.a * corner[0].x + side.b * corner[0].y + side.c;
  double most = least;
  heights_[0] = least;
  for (std::size_t k = 1; k < piece.count; ++k) {
    const double height = side.a * corner[k].x + side.b * corner[k].y + side.c;
    heights_[k] = height;
    least = std::min(least, height);
    most = std::max(most, height);
  }
  if (most > noise && least < -noise) return Side::across;
  return most + least < 0 ? Side::outside : Side::inside;
}

/// False if the piece is outside the shadow; else cutting_ are the sides that cut it.
bool VisiblePieces::mayMeet(const Piece& piece, std::span<const ShadowSide> sides, double noise) {
  cutting_.clear();
  // Most shadows are beside most pieces, and boxes around them tell.
  for (const ShadowSide& side : sides) {
    const double u = side.a > 0 ? piece.high.x : piece.low.x;
    const double v = side.b > 0 ? piece.high.y : piece.low.y;
    if (side.a * u + side.b * v + side.c < 0) return false;
  }
  for (const ShadowSide& side : sides) {
    const Side where = sideOf(piece, side, noise);
    if (where == Side::outside) return false;
    if (where == Side::across) cutting_.push_back(&side);
  }
  return true;
}

/// One part of a piece that the side last looked at cuts. The other gets the same points on the
/// cut.
VisiblePieces::Piece VisiblePieces::part(const Piece& piece, bool inside) {
  const std::size_t first = corners_.size();
  std::size_t from = piece.count - 1;
  for (std::size_t to = 0; to < piece.count; from = to++) {
    const bool from_in = heights_[from] > 0;
    const bool to_in = heights_[to] > 0;
    const Vec2 p = corners_[piece.first + from];
    const Vec2 q = corners_[piece.first + to];
    if (from_in != to_in) {
      corners_.push_back(p + (q - p) * (heights_[from] / (heights_[from] - heights_[to])));
    }
    if (to_in == inside) corners_.push_back(q);
  }
  return boxed(first);
}

/// Each side cuts off a visible convex part; the rest at the end is hidden. False if a side shows
/// that nothing is hidden: then the piece stays whole.
bool VisiblePieces::cutOut(Piece piece, double noise) {
  const std::size_t before = cut_off_.size();
  for (const ShadowSide* side : cutting_) {
    const Side where = sideOf(piece, *side, noise);
    if (where == Side::inside) continue;
    if (where == Side::outside) {
      cut_off_.resize(before);
      return false;
    }
    cut_off_.push_back(part(piece, false));
    piece = part(piece, true);
  }
  return true;
}

bool VisiblePieces::subtract(std::span<const ShadowSide> sides, double noise) {
  cut_off_.clear();
  std::size_t kept = 0;
  for (const Piece& piece : pieces_) {
    const bool hidden = mayMeet(piece, sides, noise) && cutOut(piece, noise);
    if (!hidden) pieces_[kept++] = piece;
  }
  const bool takes_away = kept < pieces_.size();
  pieces_.resize(kept);
  pieces_.insert(pieces_.end(), cut_off_.begin(), cut_off_.end());
  return takes_away;
}

}  // namespace radiosity
