#include "formfactor/rays/ray_windows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/geometry/plane_frame.h"
#include "base/geometry/segment.h"

namespace radiosity {

namespace {

using std::numbers::pi;

/// Lengths and angles by which windows are larger than computed, in scenes of size 1: rays leave
/// and go in single precision.
constexpr double kMargin = 4e-7;
/// Nodes and triangles looked at for each frame. Beyond, nodes count whole: a window is searched in
/// less time than the first rays take.
constexpr int kMostVisits = 512;

/// Places as seen from those of a frame, whose circle lies around the origin.
struct Place {
  Vec2 across;    ///< in the plane, from the circle's middle
  double height;  ///< over the plane through the middle
};

}  // namespace

/// The window of the origins of one frame.
class RayWindows::Search {
 public:
  Search(const RayFrame& frame, const std::vector<Vec3>& corners)
      : x_(frame.x), y_(frame.y), z_(frame.z), middle_(boxOf(corners).centre()) {
    for (const Vec3& corner : corners) {
      const Place place = placeOf(corner);
      radius_ = std::max(radius_, glm::length(place.across));
      rise_ = std::max(rise_, std::abs(place.height));
    }
    radius_ += kMargin;
  }

  DirectionWindow windowOf(const BoxTree& tree, const EmbreeScene& embree) const {
    DirectionWindow window;
    if (tree.nodes().empty()) return window;
    std::vector<Index> stack{0};
    for (int visits = 0; !stack.empty() && window.share() <= kMostShare; ++visits) {
      const BoxTree::Node& node = tree.nodes()[stack.back()];
      stack.pop_back();
      const DirectionWindow of_box = windowOf(node.bound);
      if (window.contains(of_box)) continue;
      if (visits >= kMostVisits) {
        window.add(of_box);
      } else if (node.count == 0) {
        stack.push_back(node.first + 1);
        stack.push_back(node.first);
      } else {
        for (Index k = node.first; k < node.first + node.count; ++k) {
          window.add(windowOf(embree, tree.order()[k]));
        }
      }
    }
    return window;
  }

 private:
  Place placeOf(const Vec3& at) const {
    const Vec3 from_middle = at - middle_;
    return {{glm::dot(x_, from_middle), glm::dot(y_, from_middle)}, glm::dot(z_, from_middle)};
  }

  /// Of places in ranges of height, of distance across and of azimuth.
  DirectionWindow between(double low, double high, double near, double far, double from,
                          double to) const {
    DirectionWindow window;
    // Nothing of it is over the plane: rays start kRayLift before it.
    if (!(high + rise_ > kRayLift)) return window;
    high += rise_ + kMargin;
    low = std::max(0.0, low - rise_ - kMargin);
    const auto squaredSine = [](double height, double across) {
      return height * height / (height * height + across * across);
    };
    const auto wider = [](double squared_sine) {
      return 2 * kMargin * std::sqrt(squared_sine * (1 - squared_sine)) + kMargin * kMargin;
    };
    window.low = low > 0 ? squaredSine(low, far) : 0.0;
    window.high = near > 0 ? squaredSine(high, near) : 1.0;
    window.low = std::max(0.0, window.low - wider(window.low));
    window.high = std::min(1.0, window.high + wider(window.high));
    window.centre = 0.5 * (from + to);
    window.half = std::min(pi, 0.5 * (to - from) + kMargin);
    return window;
  }

  /// By the ball around it.
  DirectionWindow windowOf(const Box3& box) const {
    const Vec3 half = 0.5 * box.size();
    const Place place = placeOf(box.centre());
    const double rise = glm::dot(glm::abs(z_), half);
    const double reach = glm::length(half) + radius_;
    const double distance = glm::length(place.across);
    const double low = place.height - rise;
    const double high = place.height + rise;
    if (distance <= reach) return between(low, high, 0, distance + reach, -pi, pi);
    const double azimuth = std::atan2(place.across.y, place.across.x);
    const double turn = std::asin(reach / distance);
    return between(low, high, distance - reach, distance + reach, azimuth - turn, azimuth + turn);
  }

  DirectionWindow windowOf(const EmbreeScene& embree, Index triangle) const {
    std::array<Place, 3> corners;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    double far = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = placeOf(embree.vertices()[embree.triangles()[triangle][k]] - embree.middle());
      low = std::min(low, corners[k].height);
      high = std::max(high, corners[k].height);
      far = std::max(far, glm::length(corners[k].across) + radius_);
    }
    const double near = distanceAcross(corners) - radius_;
    if (!(near > 0)) return between(low, high, 0, far, -pi, pi);
    // The triangle and the circles of origins around its corners lie to one side of the middle.
    const double azimuth = std::atan2(corners[0].across.y, corners[0].across.x);
    double from = 0;
    double to = 0;
    for (const Place& corner : corners) {
      const double turn =
          std::remainder(std::atan2(corner.across.y, corner.across.x) - azimuth, 2 * pi);
      const double wider = std::asin(std::min(1.0, radius_ / glm::length(corner.across)));
      from = std::min(from, turn - wider);
      to = std::max(to, turn + wider);
    }
    return between(low, high, near, far, azimuth + from, azimuth + to);
  }

  /// Of the triangle from the middle, in the plane; 0 if it lies over it.
  static double distanceAcross(const std::array<Place, 3>& corners) {
    double nearest = std::numeric_limits<double>::infinity();
    int left = 0;
    int right = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2& a = corners[k].across;
      const Vec2& b = corners[(k + 1) % 3].across;
      nearest = std::min(nearest, distanceToSegment(Vec2(0.0), a, b));
      const double turn = cross2(a, b);
      left += turn >= 0 ? 1 : 0;
      right += turn <= 0 ? 1 : 0;
    }
    return left == 3 || right == 3 ? 0.0 : nearest;
  }

  Vec3 x_;
  Vec3 y_;
  Vec3 z_;
  Vec3 middle_;
  double radius_ = 0;  ///< of the circle around the origins
  double rise_ = 0;    ///< most height of origins over the middle's plane, or under it
};

RayWindows::RayWindows(const EmbreeScene& embree) : embree_(embree) {
  std::vector<Box3> boxes;
  boxes.reserve(embree.triangles().size());
  for (const auto& triangle : embree.triangles()) {
    Box3& box = boxes.emplace_back();
    for (const std::uint32_t corner : triangle) {
      box.add(embree.vertices()[corner] - embree.middle());
    }
  }
  tree_ = BoxTree(boxes);
}

std::optional<DirectionWindow> RayWindows::of(const RayOrigins& origins) const {
  const DirectionWindow window =
      Search(origins.frame(), origins.corners()).windowOf(tree_, embree_);
  if (window.share() > kMostShare) return std::nullopt;
  return window;
}

}  // namespace radiosity
