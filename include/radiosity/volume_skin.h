// The skin of a mesh of volumes: the faces that belong to one of its elements alone.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/base.h"

namespace [[gnu::visibility("default")]] radiosity {

class VolumeSkin {
 public:
  struct Face {
    std::array<Index, 4> loop;  ///< vertices, counter-clockwise seen from outside
    std::size_t corners;        ///< 3 or 4
    Index volume;               ///< as add() counts them, from 0
    int side;                   ///< of the volume, 1 to 6, as CalculiX numbers them
    std::span<const Index> vertices() const { return {loop.data(), corners}; }
  };

  /// Adds an element by its corners: 4 of a tetrahedron, 5 of a pyramid, 6 of a wedge, 8 of a
  /// hexahedron, in the order that Gmsh, VTK, Abaqus and CalculiX have in common (either sense of
  /// rotation). Corners may repeat: a wedge may be written as a hexahedron. Returns false and adds
  /// nothing for another number.
  bool add(std::span<const Index> corners);
  std::size_t size() const { return begin_.size() - 1; }
  void clear();

  /// The faces of the skin by volume, then by side, in O(n log n). Sides with fewer than three
  /// corners, and volumes with the corners of an earlier one, are left out. `places`: of the
  /// vertices. Precondition: every corner that was added is an index into them.
  std::vector<Face> faces(std::span<const Vec3> places) const;

 private:
  std::span<const Index> cornersOf(std::size_t volume) const {
    return std::span(corners_).subspan(begin_[volume], begin_[volume + 1] - begin_[volume]);
  }
  /// By volume: whether it has the corners of an earlier one (Gmsh 2.2 writes a volume once for
  /// each of its physical groups).
  std::vector<bool> repeated() const;
  void turnOutward(Face& face, std::span<const Vec3> places) const;

  std::vector<Index> corners_;
  std::vector<std::size_t> begin_{0};  ///< volumes + 1, into corners_
};

}  // namespace radiosity
