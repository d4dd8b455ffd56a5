// The skin of volumes: its sides and their orientation.
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <numeric>
#include <random>

#include "radiosity/volume_skin.h"

namespace radiosity {
namespace {

struct Element {
  const char* name;
  std::vector<Vec3> places;
  std::size_t faces;
  double volume;
};

const std::vector<Element>& elements() {
  static const std::vector<Element> kElements = {
      {"tetrahedron", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 4, 1.0 / 6},
      {"pyramid", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.4, 0.5, 1}}, 5, 1.0 / 3},
      {"wedge", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, 5, 0.5},
      {"hexahedron",
       {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
       6,
       1},
  };
  return kElements;
}

std::vector<Index> inOrder(std::size_t count) {
  std::vector<Index> all(count);
  std::iota(all.begin(), all.end(), Index(0));
  return all;
}

/// The volume that the faces enclose, by the divergence theorem; below 0 if they face inward.
double enclosed(const std::vector<VolumeSkin::Face>& faces, const std::vector<Vec3>& places) {
  double volume = 0;
  for (const VolumeSkin::Face& face : faces) {
    for (std::size_t k = 2; k < face.corners; ++k) {
      volume += glm::dot(places[face.loop[0]],
                         glm::cross(places[face.loop[k - 1]], places[face.loop[k]])) /
                6;
    }
  }
  return volume;
}

TEST(VolumeSkin, EnclosesEachKindOfElementFromOutside) {
  for (const Element& element : elements()) {
    VolumeSkin skin;
    ASSERT_TRUE(skin.add(inOrder(element.places.size())));
    const auto faces = skin.faces(element.places);
    EXPECT_EQ(faces.size(), element.faces) << element.name;
    // Coordinates of at most two digits: errors of rounding alone.
    EXPECT_NEAR(enclosed(faces, element.places), element.volume, 1e-15) << element.name;
  }
}

TEST(VolumeSkin, FacesOutwardForMirroredElements) {
  for (const Element& element : elements()) {
    std::vector<Vec3> mirrored = element.places;
    for (Vec3& place : mirrored) place.z = 1e6 - place.z;
    VolumeSkin skin;
    skin.add(inOrder(element.places.size()));
    // Products of coordinates of a million are exact to 1e-4.
    EXPECT_NEAR(enclosed(skin.faces(mirrored), mirrored), element.volume, 1e-3) << element.name;
  }
}

TEST(VolumeSkin, SidesAreNumberedAsInCalculix) {
  // S1 to S6 of a unit cube look towards -z, z, -y, x, y, -x.
  const Element& cube = elements()[3];
  VolumeSkin skin;
  skin.add(inOrder(8));
  const Vec3 normals[] = {{0, 0, -1}, {0, 0, 1}, {0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
  const auto faces = skin.faces(cube.places);
  for (std::size_t k = 0; k < 6; ++k) {
    const auto& loop = faces[k].loop;
    EXPECT_EQ(faces[k].side, int(k) + 1);
    EXPECT_EQ(glm::cross(cube.places[loop[1]] - cube.places[loop[0]],
                         cube.places[loop[2]] - cube.places[loop[1]]),
              normals[k]);
  }
}

/// A grid of cells, each a cube or six tetrahedra about its diagonal, in any order.
TEST(VolumeSkin, LeavesOutSharedSides) {
  constexpr Index kSide = 4;
  std::vector<Vec3> places;
  for (Index z = 0; z <= kSide; ++z) {
    for (Index y = 0; y <= kSide; ++y) {
      for (Index x = 0; x <= kSide; ++x) places.emplace_back(x, y, z);
    }
  }
  const Index steps[] = {1, kSide + 1, (kSide + 1) * (kSide + 1)};
  std::mt19937 random(1);
  for (const bool tetrahedra : {false, true}) {
    std::vector<std::vector<Index>> cells;
    for (Index first = 0; first < places.size(); ++first) {
      const Vec3& place = places[first];
      if (std::max({place.x, place.y, place.z}) == double(kSide)) continue;
      const auto [x, y, z] = steps;
      if (!tetrahedra) {
        cells.push_back({first, first + x, first + x + y, first + y, first + z, first + x + z,
                         first + x + y + z, first + y + z});
        continue;
      }
      int axis[] = {0, 1, 2};
      do {
        const Index second = first + steps[axis[0]];
        cells.push_back({first, second, second + steps[axis[1]], first + x + y + z});
      } while (std::next_permutation(std::begin(axis), std::end(axis)));
    }
    std::shuffle(cells.begin(), cells.end(), random);
    cells.push_back(cells.front());  // a second time
    VolumeSkin skin;
    for (const std::vector<Index>& cell : cells) skin.add(cell);
    const auto faces = skin.faces(places);
    EXPECT_EQ(faces.size(), 6 * kSide * kSide * (tetrahedra ? 2U : 1U));
    // Sixths of whole numbers, some hundred of them: errors of rounding alone.
    EXPECT_NEAR(enclosed(faces, places), kSide * kSide * kSide, 1e-12);
  }
}

TEST(VolumeSkin, AWedgeMayBeWrittenAsAHexahedron) {
  const Element& wedge = elements()[2];
  VolumeSkin skin;
  skin.add(std::vector<Index>{0, 1, 2, 2, 3, 4, 5, 5});
  const auto faces = skin.faces(wedge.places);
  EXPECT_EQ(faces.size(), 5U);
  EXPECT_NEAR(enclosed(faces, wedge.places), wedge.volume, 1e-15);
}

TEST(VolumeSkin, RefusesOtherNumbersOfCorners) {
  VolumeSkin skin;
  for (const std::size_t count : {0U, 3U, 7U, 9U}) EXPECT_FALSE(skin.add(inOrder(count))) << count;
  EXPECT_TRUE(skin.faces({}).empty());
}

}  // namespace
}  // namespace radiosity
