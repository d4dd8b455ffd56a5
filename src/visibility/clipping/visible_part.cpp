#include "visibility/clipping/visible_part.h"

#include <algorithm>
#include <utility>

namespace radiosity {
namespace {

/// The edges of the target keep their numbers, those of cones come after them.
constexpr std::uint16_t kFirstConeEdge = 16;
constexpr std::uint64_t kAllHidden = 1;

/// A number for a set of edges, whatever their order: sums of scrambled labels.
std::uint64_t scramble(std::uint64_t id, std::uint64_t edge) {
  std::uint64_t x = (id + 1) * 0x9e3779b97f4a7c15ull + (edge + 1) * 0xd1b54a32d192ed03ull;
  x = (x ^ (x >> 31)) * 0x94d049bb133111ebull;
  return x ^ (x >> 29);
}

}  // namespace

/// Form factor to the part of the target that `cone` hides; the part itself ends in clipped_[0].
/// Negative if the cone hides all of the target.
double VisiblePart::clipToCone(const BlockingCone& cone, const Vec3& normal, Index id,
                               PointView& view) {
  const ConvexPolygon* now = &target_;
  int next = 0;
  for (std::size_t k = 0; k < cone.planes.size(); ++k) {
    const auto label = std::uint16_t(kFirstConeEdge + cone.labels[k]);
    const PlaneSide side = split(*now, cone.planes[k], label, &clipped_[next], nullptr);
    if (side == PlaneSide::outside) return 0;
    if (side == PlaneSide::inside) continue;
    now = &clipped_[next];
    next = 1 - next;
  }
  if (now == &target_) return -1;
  for (const std::uint16_t edge : now->edges) view.shape += scramble(id, edge);
  return std::max(0.0, lambert(*now, normal));
}

/// pieces_ minus one cone.
void VisiblePart::subtract(const BlockingCone& cone) {
  std::size_t made = 0;
  const auto keep = [&](ConvexPolygon& piece) {
    if (made == next_.size()) next_.emplace_back();
    std::swap(next_[made++], piece);
  };
  for (std::size_t p = 0; p < piece_count_; ++p) {
    const std::size_t before = made;
    std::swap(clipped_[0], pieces_[p]);
    bool hidden = true;
    // Each plane cuts off a visible convex part; the rest at the end is hidden. Copies are kept in
    // case a later plane shows that nothing is hidden: then the piece stays whole.
    whole_ = clipped_[0];
    for (const ClipPlane& plane : cone.planes) {
      const PlaneSide side = split(clipped_[0], plane, std::uint16_t(0), &clipped_[1], &outside_);
      if (side == PlaneSide::inside) continue;
      if (side == PlaneSide::outside) {
        hidden = false;
        break;
      }
      keep(outside_);
      std::swap(clipped_[0], clipped_[1]);
    }
    if (!hidden) {
      made = before;
      keep(whole_);
    }
  }
  std::swap(pieces_, next_);
  piece_count_ = made;
}

/// Form factor to the target without all shadows, cut into convex pieces.
double VisiblePart::subtractAll(const Vec3& normal) {
  // The largest first: it leaves the least to be cut by the others.
  std::sort(shadows_.begin(), shadows_.begin() + std::ptrdiff_t(shadow_count_),
            [](const Shadow& a, const Shadow& b) {
              return a.form_factor != b.form_factor ? a.form_factor > b.form_factor : a.id < b.id;
            });
  if (pieces_.empty()) pieces_.emplace_back();
  pieces_[0] = target_;
  piece_count_ = 1;
  for (std::size_t k = 0; k < shadow_count_ && piece_count_ > 0; ++k) subtract(shadows_[k].cone);
  double sum = 0;
  for (std::size_t p = 0; p < piece_count_; ++p) sum += std::max(0.0, lambert(pieces_[p], normal));
  return sum;
}

PointView VisiblePart::look(const Vec3& eye, const Vec3& normal, std::span<const Vec3> target,
                            std::span<const Blocker> blockers) {
  PointView view;
  target_.assign(target, eye);
  view.whole = std::max(0.0, lambert(target_, normal));
  shadow_count_ = 0;
  for (const Blocker& blocker : blockers) {
    if (shadow_count_ == shadows_.size()) shadows_.emplace_back();
    Shadow& shadow = shadows_[shadow_count_];
    if (!blockingCone(*blocker.body, eye, blocker.cuts_target, shadow.cone)) continue;
    shadow.id = blocker.id;
    shadow.form_factor =
        shadow.cone.inside ? -1 : clipToCone(shadow.cone, normal, blocker.id, view);
    if (shadow.form_factor < 0) {
      view.visible = 0;
      view.shape = kAllHidden;
      return view;
    }
    if (shadow.form_factor > 0) ++shadow_count_;
  }
  // Differences and sums of rounded terms: kept from passing the ends by their last digits.
  if (shadow_count_ == 0) {
    view.visible = view.whole;
  } else if (shadow_count_ == 1) {
    view.visible = std::max(0.0, view.whole - shadows_[0].form_factor);
  } else {
    view.visible = std::min(view.whole, subtractAll(normal));
  }
  return view;
}

}  // namespace radiosity
