#include "radiosity/volume_skin.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <tuple>

namespace radiosity {

namespace {

/// The corners of a side; -1 as the fourth of a triangle. Sides are in the order of Dhondt,
/// "CalculiX CrunchiX User's Manual", section "Element types"; pyramids, which it lacks, have the
/// base first.
using Side = std::array<int, 4>;
constexpr std::array<Side, 4> kTetrahedron = {
    {{0, 2, 1, -1}, {0, 1, 3, -1}, {1, 2, 3, -1}, {2, 0, 3, -1}}};
constexpr std::array<Side, 5> kPyramid = {
    {{0, 3, 2, 1}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}}};
constexpr std::array<Side, 5> kWedge = {
    {{0, 2, 1, -1}, {3, 4, 5, -1}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}};
constexpr std::array<Side, 6> kHexahedron = {
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};

std::span<const Side> sidesOf(std::size_t corners) {
  switch (corners) {
    case 4:
      return kTetrahedron;
    case 5:
      return kPyramid;
    case 6:
      return kWedge;
    case 8:
      return kHexahedron;
    default:
      return {};
  }
}

/// The side's vertices in order, each once. False if there are fewer than three, or if the side
/// touches itself.
bool loopOf(const Side& side, std::span<const Index> corners, VolumeSkin::Face& face) {
  face.corners = 0;
  for (const int corner : side) {
    if (corner < 0) break;
    const Index vertex = corners[std::size_t(corner)];
    if (face.corners > 0 && face.loop[face.corners - 1] == vertex) continue;
    face.loop[face.corners++] = vertex;
  }
  while (face.corners > 1 && face.loop[face.corners - 1] == face.loop[0]) --face.corners;
  if (face.corners < 3) return false;
  return face.corners == 3 || (face.loop[0] != face.loop[2] && face.loop[1] != face.loop[3]);
}

/// A key of a side, the same for both elements that share it.
std::array<Index, 4> keyOf(const VolumeSkin::Face& face) {
  std::array<Index, 4> key = face.loop;
  if (face.corners == 3) key[3] = kNone;
  std::sort(key.begin(), key.end());
  return key;
}

}  // namespace

bool VolumeSkin::add(std::span<const Index> corners) {
  if (sidesOf(corners.size()).empty()) return false;
  corners_.insert(corners_.end(), corners.begin(), corners.end());
  begin_.push_back(corners_.size());
  return true;
}

void VolumeSkin::clear() { *this = VolumeSkin(); }

// Programs write wedges in either orientation, and moved nodes may turn an element inside out. So
// the middle of the element decides.
void VolumeSkin::turnOutward(Face& face, std::span<const Vec3> places) const {
  const std::span<const Index> corners = cornersOf(face.volume);
  const Vec3& origin = places[corners[0]];  // differences are accurate far from 0, too
  Vec3 middle(0.0);
  for (const Index corner : corners) middle += (places[corner] - origin) / double(corners.size());
  Vec3 area(0.0);
  Vec3 centre(0.0);
  for (std::size_t k = 0; k < face.corners; ++k) {
    const Vec3 here = places[face.loop[k]] - origin;
    const Vec3 next = places[face.loop[(k + 1) % face.corners]] - origin;
    area += glm::cross(here, next);
    centre += here / double(face.corners);
  }
  if (glm::dot(area, centre - middle) < 0) {
    std::reverse(face.loop.begin(), face.loop.begin() + std::ptrdiff_t(face.corners));
  }
}

std::vector<bool> VolumeSkin::repeated() const {
  struct Keyed {
    std::array<Index, 8> key;
    Index volume;
    auto operator<=>(const Keyed&) const = default;
  };
  std::vector<Keyed> volumes(size());
  for (std::size_t v = 0; v < size(); ++v) {
    std::array<Index, 8>& key = volumes[v].key;
    key.fill(kNone);
    std::ranges::copy(cornersOf(v), key.begin());
    std::sort(key.begin(), key.end());
    volumes[v].volume = Index(v);
  }
  std::sort(volumes.begin(), volumes.end());
  std::vector<bool> found(size(), false);
  for (std::size_t k = 1; k < volumes.size(); ++k) {
    found[volumes[k].volume] = volumes[k].key == volumes[k - 1].key;
  }
  return found;
}

std::vector<VolumeSkin::Face> VolumeSkin::faces(std::span<const Vec3> places) const {
  struct Keyed {
    std::array<Index, 4> key;
    Face face;
  };
  const std::vector<bool> is_repeated = repeated();
  std::vector<Keyed> sides;
  for (std::size_t v = 0; v < size(); ++v) {
    if (is_repeated[v]) continue;
    const std::span<const Index> corners = cornersOf(v);
    const std::span<const Side> of_volume = sidesOf(corners.size());
    for (std::size_t s = 0; s < of_volume.size(); ++s) {
      Face face{{}, 0, Index(v), int(s) + 1};
      if (loopOf(of_volume[s], corners, face)) sides.push_back({keyOf(face), face});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Keyed& a, const Keyed& b) { return a.key < b.key; });
  std::vector<Face> outer;
  for (std::size_t k = 0; k < sides.size();) {
    std::size_t end = k + 1;
    while (end < sides.size() && sides[end].key == sides[k].key) ++end;
    if (end == k + 1) outer.push_back(sides[k].face);
    k = end;
  }
  std::sort(outer.begin(), outer.end(), [](const Face& a, const Face& b) {
    return std::tie(a.volume, a.side) < std::tie(b.volume, b.side);
  });
  for (Face& face : outer) turnOutward(face, places);
  return outer;
}

}  // namespace radiosity
