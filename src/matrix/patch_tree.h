// Patches in a binary tree by place and normal, and the linear fit of a field to these over a node.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "radiosity/base.h"

namespace radiosity {

/// The numbers of a place and of a normal.
inline constexpr std::size_t kPatchFeatures = 6;

/// One patch a leaf. A node is halved, by number, along that of place and normal over which its
/// patches spread most.
class PatchTree {
 public:
  /// A place, in any unit and from any origin that leave it some six digits, then a unit normal.
  using Features = std::array<float, kPatchFeatures>;
  struct Patch {
    Features at{};
    double area = 0;    ///< above 0; the weight of the patch
    double counts = 1;  ///< what is multiplied to a field at the patch
    Index patch = 0;
  };
  /// Has the patches patches()[begin] to patches()[end - 1]. Nodes are in preorder.
  struct Node {
    Index begin = 0;
    Index end = 0;

    bool isLeaf() const { return end - begin == 1; }
  };
  /// Features over an inner node, relative to the node: f = ((place - middle) / radius,
  /// normal - middle). Their means by area are 0.
  struct Fit {
    std::array<double, kPatchFeatures> middle{};
    double radius = 0;  ///< of the places about the middle
    /// The inverse of the covariance C of f, a little more than C, row by row. A field B is
    /// fitted by mean(B) + mean(f B)' C^-1 f.
    std::array<float, kPatchFeatures * kPatchFeatures> inverse{};

    /// What features are divided by: the radius, and 1 for normals.
    double unitOf(std::size_t feature) const { return feature < 3 ? radius : 1.0; }
    /// f of a patch or of the middle of some.
    std::array<double, kPatchFeatures> relative(const std::array<double, kPatchFeatures>& at) const;
    /// C^-1 f.
    std::array<double, kPatchFeatures> solve(const std::array<double, kPatchFeatures>& f) const;
  };

  PatchTree() = default;
  /// Sorts the patches. O(n log n).
  explicit PatchTree(std::vector<Patch> patches);
  /// Of patches that an earlier tree has sorted.
  static PatchTree ofSorted(std::vector<Patch> patches);

  std::span<const Patch> patches() const { return patches_; }
  void setCounts(std::size_t place, double counts) { patches_[place].counts = counts; }
  std::span<const Node> nodes() const { return nodes_; }
  /// The children of an inner node.
  std::size_t first(std::size_t node) const { return node + 1; }
  std::size_t second(std::size_t node) const {
    const Node& first = nodes_[node + 1];
    return node + 2 * std::size_t(first.end - first.begin);
  }
  /// The mean of a feature over a node.
  double middle(std::size_t node, std::size_t feature) const {
    const Node& of = nodes_[node];
    return of.isLeaf() ? double(patches_[of.begin].at[feature]) : fit(node).middle[feature];
  }
  /// Of an inner node.
  const Fit& fit(std::size_t node) const { return fits_[node - nodes_[node].begin]; }
  std::size_t bytes() const {
    return patches_.size() * sizeof(Patch) + nodes_.size() * sizeof(Node) +
           fits_.size() * sizeof(Fit);
  }

 private:
  void sort(std::size_t begin, std::size_t end);
  void grow();
  void growNode(std::size_t node, std::size_t begin, std::size_t end);

  std::vector<Patch> patches_;
  std::vector<Node> nodes_;  ///< twice as many as patches, less one
  std::vector<Fit> fits_;    ///< of inner nodes, in preorder: before node k are k - begin of these
};

/// Calls both, for the halves of a node, in parallel if it has many patches.
template <class First, class Second>
void inHalves(std::size_t patches, const First& first, const Second& second) {
  constexpr std::size_t kGrain = 4096;
  if (patches >= kGrain) return parallelBoth(first, second);
  first();
  second();
}

/// A field as the nodes of a tree see it: its mean by area, and its slopes along f.
struct NodeField {
  double mean = 0;
  std::array<double, kPatchFeatures> slope{};
};

/// The fields of all bands over all nodes: bands values a node. `x`: N * bands, by patch.
std::vector<NodeField> nodeFields(const PatchTree& tree, std::span<const double> x, int bands);

}  // namespace radiosity
