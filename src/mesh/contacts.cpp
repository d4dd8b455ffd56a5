#include "mesh/contacts.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "mesh/plane_image.h"

namespace radiosity {

namespace {

enum class Place { outside, border, inside };

double distanceToSegment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double t = std::clamp(glm::dot(p - a, d) / glm::dot(d, d), 0.0, 1.0);
  return glm::distance(p, a + t * d);
}

class ContactFinder {
 public:
  ContactFinder(InputFaces& input, const std::vector<Plane>& planes, EdgeTable& edges)
      : input_(input), planes_(planes), edges_(edges) {}

  void pair(const Sheet& f, const Sheet& g);

 private:
  bool addTraces(const Sheet& sheet, const Plane& plane, std::vector<Vec3>& points) const;
  Place place(const Vec3& p, const Sheet& sheet) const;
  void add(const Vec3& from, const Vec3& to, Index plane);

  InputFaces& input_;
  const std::vector<Plane>& planes_;
  EdgeTable& edges_;
};

/// The points where the border of `sheet` meets `plane`: vertices within coincidence of it, and
/// crossings of edges. False if there are none, or if the whole sheet lies along the plane.
bool ContactFinder::addTraces(const Sheet& sheet, const Plane& plane,
                              std::vector<Vec3>& points) const {
  const double eps = input_.coincidence;
  bool above = false;
  bool below = false;
  bool on = false;
  for (const auto& [from, to] : sheet.edges) {
    const double d = plane.distance(input_.points[from]);
    above = above || d > eps;
    below = below || d < -eps;
    on = on || std::abs(d) <= eps;
  }
  if (!(above && below) && !(on && (above || below))) return false;
  for (const auto& [from, to] : sheet.edges) {
    const Vec3& a = input_.points[from];
    const Vec3& b = input_.points[to];
    const double da = plane.distance(a);
    const double db = plane.distance(b);
    if (std::abs(da) <= eps) points.push_back(a);
    if (std::abs(db) <= eps) points.push_back(b);
    if ((da > eps && db < -eps) || (da < -eps && db > eps)) {
      points.push_back(a + (b - a) * (da / (da - db)));
    }
  }
  return true;
}

/// Even-odd in the plane's image; the border is everything closer than coincidence to an edge.
Place ContactFinder::place(const Vec3& p, const Sheet& sheet) const {
  if (!sheet.box.grown(input_.coincidence).contains(p)) return Place::outside;
  const PlaneImage frame(planes_[sheet.plane].normal);
  const Vec2 q = frame(p);
  bool inside = false;
  for (const auto& [from, to] : sheet.edges) {
    const Vec3& a3 = input_.points[from];
    const Vec3& b3 = input_.points[to];
    if (distanceToSegment(p, a3, b3) <= input_.coincidence) return Place::border;
    const Vec2 a = frame(a3);
    const Vec2 b = frame(b3);
    if ((a.y > q.y) != (b.y > q.y) && q.x < a.x + (b.x - a.x) * ((q.y - a.y) / (b.y - a.y))) {
      inside = !inside;
    }
  }
  return inside ? Place::inside : Place::outside;
}

void ContactFinder::add(const Vec3& from, const Vec3& to, Index plane) {
  const Index a = input_.points.insert(from);
  const Index b = input_.points.insert(to);
  if (a != b) edges_.addContact(a, b, plane);
}

/// Both sheets' traces lie on one line, where the planes meet. Between neighbouring traces
/// neither sheet begins or ends, so one look in the middle tells what is there.
void ContactFinder::pair(const Sheet& f, const Sheet& g) {
  std::vector<Vec3> points;
  if (!addTraces(f, planes_[g.plane], points) || !addTraces(g, planes_[f.plane], points)) return;
  const auto farther = [](const Vec3& from) {
    return [from](const Vec3& a, const Vec3& b) {
      return glm::distance(a, from) < glm::distance(b, from);
    };
  };
  const Vec3 start = *std::max_element(points.begin(), points.end(), farther(points.front()));
  const Vec3 end = *std::max_element(points.begin(), points.end(), farther(start));
  const Vec3 along = end - start;
  std::sort(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) {
    return glm::dot(a - start, along) < glm::dot(b - start, along);
  });
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    if (points[k] == points[k + 1]) continue;
    const Vec3 middle = 0.5 * (points[k] + points[k + 1]);
    const Place in_f = place(middle, f);
    const Place in_g = in_f == Place::outside ? Place::outside : place(middle, g);
    if (in_g == Place::outside) continue;
    if (in_f == Place::inside) add(points[k], points[k + 1], f.plane);
    if (in_g == Place::inside) add(points[k], points[k + 1], g.plane);
  }
}

}  // namespace

void addContacts(InputFaces& input, const std::vector<Plane>& planes,
                 const std::vector<Sheet>& sheets, EdgeTable& edges, Progress& progress) {
  std::vector<Box3> boxes;
  boxes.reserve(sheets.size());
  for (const Sheet& sheet : sheets) boxes.push_back(sheet.box.grown(input.coincidence));
  const auto pairs = overlappingPairs(boxes);
  progress.begin("contacts", pairs.size());
  ContactFinder finder(input, planes, edges);
  for (const auto& [f, g] : pairs) {
    progress.check();
    if (sheets[f].plane != sheets[g].plane) finder.pair(sheets[f], sheets[g]);
    progress.advance();
  }
  progress.end();
}

}  // namespace radiosity
