#include "mesh/arrangement/contacts.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <span>
#include <unordered_map>

#include "base/geometry/containment.h"
#include "base/geometry/segment.h"
#include "base/parallel.h"
#include "mesh/arrangement/edge_rows.h"
#include "mesh/plane_image.h"

namespace radiosity {

namespace {

constexpr std::size_t kPairsAtATime = 256;  // of sheets, for each task of a thread
// For sheets with more edges than this we search by rows.
constexpr std::size_t kManyEdges = 64;

/// The places of a sheet's points relative to a plane.
struct Sides {
  bool above = false;
  bool below = false;
  bool on = false;

  void add(double distance, double eps) {
    above = above || distance > eps;
    below = below || distance < -eps;
    on = on || std::abs(distance) <= eps;
  }
  /// Whether the points are neither all on one side nor all in the plane.
  bool meets() const { return (above && below) || (on && (above || below)); }
};

/// A line along which another sheet touches or crosses the sheets of a plane.
struct Contact {
  Vec3 from{0.0};
  Vec3 to{0.0};
  Index plane = kNone;
  double coincidence = 0;  ///< of the two sheets, m
};

class ContactFinder {
 public:
  ContactFinder(InputFaces& input, const std::vector<Plane>& planes,
                const std::vector<Sheet>& sheets, EdgeTable& edges);

  /// Whether each of two sheets reaches the other's plane and does not lie along it.
  bool mayMeet(Index f, Index g) const;
  /// Appends the contacts of two sheets that may meet.
  void pair(Index f, Index g, std::vector<Contact>& out) const;
  void add(const Contact& contact);

 private:
  std::span<const Index> edgesBeside(Index sheet, const Box3& box, std::vector<Index>& some) const;
  /// Sheets coincide as far as the smaller of them allows.
  double coincidenceOf(Index f, Index g) const {
    return std::min(sheets_[f].coincidence, sheets_[g].coincidence);
  }
  Sides sidesOf(Index sheet, const Plane& plane, double eps) const;
  void addTraces(Index sheet, Index other, std::vector<Vec3>& points) const;
  Containment place(const Vec3& p, Index sheet, double eps) const;
  std::span<const Index> edgesAt(Index sheet, const Vec2& q) const;
  InputFaces& input_;
  const std::vector<Plane>& planes_;
  const std::vector<Sheet>& sheets_;
  EdgeTable& edges_;
  std::unordered_map<Index, EdgeRows> rows_;  ///< of sheets with many edges
  std::vector<Index> all_;                    ///< 0, 1, 2, ...: all edges of a sheet without rows
};

ContactFinder::ContactFinder(InputFaces& input, const std::vector<Plane>& planes,
                             const std::vector<Sheet>& sheets, EdgeTable& edges)
    : input_(input), planes_(planes), sheets_(sheets), edges_(edges), all_(kManyEdges) {
  std::iota(all_.begin(), all_.end(), Index(0));
  for (Index s = 0; s < sheets.size(); ++s) {
    if (sheets[s].edges.size() <= kManyEdges) continue;
    rows_.try_emplace(s, input.points, PlaneImage(planes[sheets[s].plane].normal), sheets[s].edges,
                      2.0 * input.coincidence);
  }
}

bool ContactFinder::mayMeet(Index f, Index g) const {
  const double eps = coincidenceOf(f, g);
  return sheets_[f].plane != sheets_[g].plane &&
         sidesOf(f, planes_[sheets_[g].plane], eps).meets() &&
         sidesOf(g, planes_[sheets_[f].plane], eps).meets();
}

/// The edges of a sheet that may meet a box; `some` is storage for them.
std::span<const Index> ContactFinder::edgesBeside(Index sheet, const Box3& box,
                                                  std::vector<Index>& some) const {
  const auto rows = rows_.find(sheet);
  if (rows == rows_.end()) return std::span(all_).first(sheets_[sheet].edges.size());
  const PlaneImage image(planes_[sheets_[sheet].plane].normal);
  const auto [low, high] = std::minmax({image(box.low).y, image(box.high).y});
  some = rows->second.between(low - input_.coincidence, high + input_.coincidence);
  return some;
}

/// The edges of a sheet that may be near a point of its image, or to the right of the point.
std::span<const Index> ContactFinder::edgesAt(Index sheet, const Vec2& q) const {
  const auto rows = rows_.find(sheet);
  if (rows == rows_.end()) return std::span(all_).first(sheets_[sheet].edges.size());
  return rows->second.at(q.y);
}

/// For a sheet with many edges, the four corners of its box in the sheet's plane are enough, unless
/// the sheet is nearly parallel to the other plane: the box extends a few times as far as the
/// sheet.
Sides ContactFinder::sidesOf(Index number, const Plane& plane, double eps) const {
  const Sheet& sheet = sheets_[number];
  Sides out;
  if (rows_.count(number) > 0) {
    const PlaneImage image(planes_[sheet.plane].normal);
    const Vec3& inside = input_.points[sheet.edges[0][0]];
    const Vec2 low = image(sheet.box.low);
    const Vec2 high = image(sheet.box.high);
    Sides far;
    for (const Vec2& q : {low, Vec2(low.x, high.y), Vec2(high.x, low.y), high}) {
      const double d = plane.distance(image.lift(q, inside, planes_[sheet.plane].normal));
      out.add(d, eps);
      far.add(d, 4.0 * eps);
    }
    if (far.above || far.below) return out;
    out = {};
  }
  for (const auto& [from, to] : sheet.edges) out.add(plane.distance(input_.points[from]), eps);
  return out;
}

/// Adds the points where the border of a sheet meets the plane of another one near that sheet:
/// vertices within coincidence of the plane, and crossings of edges.
void ContactFinder::addTraces(Index number, Index other, std::vector<Vec3>& points) const {
  const double eps = coincidenceOf(number, other);
  const Sheet& sheet = sheets_[number];
  const Plane& plane = planes_[sheets_[other].plane];
  const Box3 beside = sheets_[other].box.grown(2.0 * eps);
  std::vector<Index> some;
  for (const Index k : edgesBeside(number, sheets_[other].box, some)) {
    const Vec3& a = input_.points[sheet.edges[k][0]];
    const Vec3& b = input_.points[sheet.edges[k][1]];
    if (!beside.meets(Box3{glm::min(a, b), glm::max(a, b)})) continue;
    const double da = plane.distance(a);
    const double db = plane.distance(b);
    if (std::abs(da) <= eps) points.push_back(a);
    if (std::abs(db) <= eps) points.push_back(b);
    if ((da > eps && db < -eps) || (da < -eps && db > eps)) {
      points.push_back(a + (b - a) * (da / (da - db)));
    }
  }
}

/// The place of a point relative to a sheet: even-odd in the plane's image. Points closer than
/// coincidence to an edge are on the border.
Containment ContactFinder::place(const Vec3& p, Index number, double eps) const {
  const Sheet& sheet = sheets_[number];
  if (!sheet.box.grown(eps).contains(p)) return Containment::outside;
  const PlaneImage frame(planes_[sheet.plane].normal);
  const Vec2 q = frame(p);
  bool inside = false;
  for (const Index k : edgesAt(number, q)) {
    const Vec3& a3 = input_.points[sheet.edges[k][0]];
    const Vec3& b3 = input_.points[sheet.edges[k][1]];
    if (distanceToSegment(p, a3, b3) <= eps) return Containment::on;
    const Vec2 a = frame(a3);
    const Vec2 b = frame(b3);
    if ((a.y > q.y) != (b.y > q.y) && q.x < a.x + (b.x - a.x) * ((q.y - a.y) / (b.y - a.y))) {
      inside = !inside;
    }
  }
  return inside ? Containment::inside : Containment::outside;
}

void ContactFinder::add(const Contact& contact) {
  const Index a = input_.points.insert(contact.from, contact.coincidence);
  const Index b = input_.points.insert(contact.to, contact.coincidence);
  if (a != b) edges_.addContact(a, b, contact.plane);
}

/// Both sheets' traces lie on the line where the planes meet. Between neighbouring traces neither
/// sheet begins or ends, so a test at the middle decides for the whole segment.
void ContactFinder::pair(Index f, Index g, std::vector<Contact>& out) const {
  std::vector<Vec3> points;
  addTraces(f, g, points);
  addTraces(g, f, points);
  if (points.empty()) return;
  const auto farther = [](const Vec3& from) {
    return [from](const Vec3& a, const Vec3& b) {
      return glm::distance(a, from) < glm::distance(b, from);
    };
  };
  const Vec3 start = *std::max_element(points.begin(), points.end(), farther(points.front()));
  const Vec3 end = *std::max_element(points.begin(), points.end(), farther(start));
  const Vec3 along = end - start;
  const double eps = coincidenceOf(f, g);
  std::sort(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) {
    return glm::dot(a - start, along) < glm::dot(b - start, along);
  });
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    if (points[k] == points[k + 1]) continue;
    const Vec3 middle = 0.5 * (points[k] + points[k + 1]);
    const Containment in_f = place(middle, f, eps);
    const Containment in_g =
        in_f == Containment::outside ? Containment::outside : place(middle, g, eps);
    if (in_g == Containment::outside) continue;
    const auto contact = [&](Index in) {
      out.push_back({points[k], points[k + 1], sheets_[in].plane, eps});
    };
    if (in_f == Containment::inside) contact(f);
    if (in_g == Containment::inside) contact(g);
  }
}

}  // namespace

void addContacts(InputFaces& input, const std::vector<Plane>& planes,
                 const std::vector<Sheet>& sheets, EdgeTable& edges, Progress& progress) {
  std::vector<Box3> boxes;
  boxes.reserve(sheets.size());
  for (const Sheet& sheet : sheets) boxes.push_back(sheet.box.grown(sheet.coincidence));
  ContactFinder finder(input, planes, sheets, edges);
  const auto pairs =
      overlappingPairs(boxes, &progress, [&](Index f, Index g) { return finder.mayMeet(f, g); });
  progress.begin("contacts", pairs.size());
  std::vector<std::vector<Contact>> found((pairs.size() + kPairsAtATime - 1) / kPairsAtATime);
  parallelFor(found.size(), 1, [&](std::size_t block) {
    if (progress.cancelled()) return;
    const std::size_t begin = block * kPairsAtATime;
    const std::size_t end = std::min(pairs.size(), begin + kPairsAtATime);
    for (std::size_t k = begin; k < end; ++k) {
      finder.pair(pairs[k].first, pairs[k].second, found[block]);
    }
    progress.advance(end - begin);
  });
  progress.check();
  for (const auto& contacts : found) {
    for (const Contact& contact : contacts) finder.add(contact);
  }
  progress.end();
}

}  // namespace radiosity
