// Sheets, from which the arrangement of a plane is made, and the edges that they share.
#pragma once

#include <array>
#include <boost/container/small_vector.hpp>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "mesh/box_pairs.h"
#include "mesh/faces/plane_groups.h"

namespace radiosity {

/// Coplanar faces of one surface that face alike and are connected by edges. A sheet has no edges
/// between its faces, only the boundary.
struct Sheet {
  Index plane = kNone;
  Index surface = kNone;
  int facing = 1;                           ///< +1: along the plane's normal, -1: against it
  std::vector<Index> faces;                 ///< into InputFaces::faces
  std::vector<std::array<Index, 2>> edges;  ///< boundary, the sheet on the left seen from its front
  Box3 box;
  double coincidence = std::numeric_limits<double>::infinity();  ///< the least of its faces', m
};

std::vector<Sheet> findSheets(const InputFaces& input, const std::vector<Plane>& planes);

/// A sheet along an edge. `count` > 0: it runs from the smaller to the larger vertex; < 0: back.
/// The magnitude is more than 1 if a sheet overlaps itself.
struct EdgeUse {
  Index sheet = kNone;
  int count = 0;
};

/// An edge of the complex, between vertices a < b.
struct Edge {
  Index a = kNone;
  Index b = kNone;
  /// Ascending by sheet. Most edges have a sheet on each side.
  boost::container::small_vector<EdgeUse, 2> uses;
  /// Planes in which another plane's sheet touches or crosses along it.
  boost::container::small_vector<Index, 2> contacts;

  bool alive() const { return !uses.empty() || !contacts.empty(); }
};

/// All edges, each once. Split edges stay as dead entries.
class EdgeTable {
 public:
  /// Reserves room for `count` edges.
  void reserve(std::size_t count);
  Index find(Index a, Index b) const;
  /// The edge between a and b (a != b); made if there is none.
  Index obtain(Index a, Index b);
  void addUse(Index from, Index to, Index sheet, int count);
  void addContact(Index a, Index b, Index plane);
  /// Replaces an edge by the path over `between` (from a to b); returns the path's edges.
  std::vector<Index> split(Index edge, const std::vector<Index>& between);
  /// Replaces every vertex v by target[v]; returns the resulting edges.
  std::vector<Index> merge(const std::vector<Index>& target);
  /// The edges replaced since the last call, in their old state, in no order.
  std::vector<Edge> takeReplaced() { return std::exchange(replaced_, {}); }

  const Edge& operator[](Index e) const { return edges_[e]; }
  std::size_t size() const { return edges_.size(); }

 private:
  /// Moves the uses and contacts of an edge to the path from its a to its b.
  std::vector<Index> replace(Index edge, const std::vector<Index>& path);

  std::vector<Edge> edges_;
  std::vector<Edge> replaced_;
  std::unordered_map<std::uint64_t, Index> index_;
};

}  // namespace radiosity
