#include "mesh/cells/edge_gaps.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "mesh/box_pairs.h"

namespace radiosity {

namespace {

struct Segment {
  Vec3 start;
  Vec3 end;
};

double lengthOf(const Segment& s) { return glm::length(s.end - s.start); }

/// The view from a segment: coordinates along it and to its left.
class View {
 public:
  View(const Segment& from, const Vec3& normal)
      : start_(from.start), length_(glm::length(from.end - from.start)) {
    along_ = (from.end - from.start) / length_;
    left_ = glm::cross(normal, along_);
  }
  Vec2 operator()(const Vec3& p) const {
    return {glm::dot(p - start_, along_), glm::dot(p - start_, left_)};
  }
  double length() const { return length_; }

 private:
  Vec3 start_;
  double length_;
  Vec3 along_;
  Vec3 left_;
};

/// The part of b beside the viewing segment, within its length. `side`: 1 for its left, -1 for its
/// right.
std::optional<Gap> gapTo(const View& view, const Segment& b, double side, double reach) {
  Vec2 p = view(b.start);
  Vec2 q = view(b.end);
  if (p.x > q.x) std::swap(p, q);
  if (q.x < 0 || p.x > view.length()) return std::nullopt;
  const auto heightAt = [&](double x) {
    return q.x > p.x ? p.y + (q.y - p.y) * ((x - p.x) / (q.x - p.x)) : p.y;
  };
  Gap gap;
  gap.from = std::clamp(p.x, 0.0, view.length());
  gap.to = std::clamp(q.x, 0.0, view.length());
  gap.gap_from = side * (p.x < 0 ? heightAt(0) : p.y);
  gap.gap_to = side * (q.x > view.length() ? heightAt(view.length()) : q.y);
  if (std::min(gap.gap_from, gap.gap_to) <= 0 || std::min(gap.gap_from, gap.gap_to) >= reach) {
    return std::nullopt;
  }
  return gap;
}

}  // namespace

void forGaps(const std::vector<Vec3>& vertices, const Vec3& normal,
             const std::vector<PolygonEdge>& edges, double reach,
             const std::function<void(std::size_t, const Gap&)>& found) {
  const auto segmentOf = [&](std::size_t k) {
    return Segment{vertices[edges[k].ends[0]], vertices[edges[k].ends[1]]};
  };
  // The edges' boxes, and the same boxes grown by the distance that each edge looks.
  std::vector<Box3> boxes(2 * edges.size());
  std::vector<Index> looking(edges.size());
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const Segment segment = segmentOf(k);
    boxes[k].add(segment.start);
    boxes[k].add(segment.end);
    boxes[edges.size() + k] = boxes[k].grown(std::min(reach, 0.5 * lengthOf(segment)));
    looking[k] = Index(edges.size() + k);
  }
  // Whether a part of b lies on the inner side of the polygon at a.
  const auto faces = [&](std::size_t a, std::size_t b) {
    if (edges[a].both_sides) return true;
    const View view(segmentOf(a), normal);
    return view(segmentOf(b).start).y > 0 || view(segmentOf(b).end).y > 0;
  };
  const auto measure = [&](std::size_t a, std::size_t b) {
    if (!faces(b, a)) return;
    const View view(segmentOf(a), normal);
    for (const double side : {1.0, -1.0}) {
      if (side < 0 && !edges[a].both_sides) continue;
      const double look = std::min(reach, 0.5 * view.length());
      if (const auto gap = gapTo(view, segmentOf(b), side, look)) found(a, *gap);
    }
  };
  for (const auto& [b, a_grown] : overlappingPairs(boxes, looking)) {
    if (b >= edges.size()) continue;
    const std::size_t a = a_grown - edges.size();
    const auto& x = edges[a].ends;
    const auto& y = edges[b].ends;
    if (x[0] == y[0] || x[0] == y[1] || x[1] == y[0] || x[1] == y[1]) continue;
    measure(a, b);
  }
}

}  // namespace radiosity
