#include "formfactor/exact/assembly/shared_tasks.h"

#include <optional>
#include <utility>

#include "base/byte_stream.h"
#include "base/hand_out.h"
#include "base/made.h"
#include "formfactor/exact/assembly/task_journal.h"

namespace radiosity {

namespace {

/// Blocks for each process: many, so that nobody waits long for the slowest.
constexpr std::size_t kBlocksAProcess = 16;

/// The top of the tree of sums, as tbb::parallel_deterministic_reduce makes it: halves of halves of
/// the tasks. Its leaves are handed out. Sums are added as soon as both halves are there.
class SumTree {
 public:
  SumTree(std::size_t tasks, std::size_t leaves) {
    const std::size_t most = std::max<std::size_t>(1, tasks / std::max<std::size_t>(leaves, 1));
    if (tasks > 0) add(0, tasks, most, kNone);
  }

  struct Leaf {
    std::size_t begin;
    std::size_t end;
  };
  std::size_t leaves() const { return leaf_node_.size(); }
  Leaf leaf(std::size_t k) const { return nodes_[leaf_node_[k]].range; }

  void put(std::size_t leaf, RowSums sums) {
    Index at = leaf_node_[leaf];
    nodes_[at].sums.emplace(std::move(sums));
    for (Index above = nodes_[at].above; above != kNone; above = nodes_[at].above) {
      Node& node = nodes_[above];
      std::optional<RowSums>& first = nodes_[node.halves[0]].sums;
      std::optional<RowSums>& second = nodes_[node.halves[1]].sums;
      if (!first || !second) return;
      *first += *second;
      second.reset();
      node.sums = std::exchange(first, std::nullopt);
      at = above;
    }
  }
  RowSums take(RowSums none) {
    return nodes_.empty() ? std::move(none) : std::move(made(nodes_.front().sums));
  }

 private:
  struct Node {
    Leaf range;
    Index above;
    Index halves[2] = {kNone, kNone};
    std::optional<RowSums> sums{};
  };

  Index add(std::size_t begin, std::size_t end, std::size_t most, Index above) {
    const auto at = Index(nodes_.size());
    nodes_.push_back({{begin, end}, above});
    if (end - begin <= most) {
      leaf_node_.push_back(at);
      return at;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    const Index first = add(begin, middle, most, at);
    const Index second = add(middle, end, most, at);
    nodes_[at].halves[0] = first;
    nodes_[at].halves[1] = second;
    return at;
  }

  std::vector<Node> nodes_;
  std::vector<Index> leaf_node_;
};

/// Rows of some tasks, by rank.
struct Ranks {
  Ranks(const RowContext& context, const RowTasks& tasks, SumTree::Leaf leaf)
      : first(context.order.rank[tasks[leaf.begin].front().first]),
        end(std::size_t(context.order.rank[tasks[leaf.end - 1].back().end - 1]) + 1) {}
  std::size_t first;
  std::size_t end;
};

}  // namespace

RowSums shareTasks(Processes& processes, const RowContext& context, const RowTasks& tasks,
                   const SumTasks& sum, Progress& progress) {
  SumTree tree(tasks.size(), kBlocksAProcess * std::size_t(processes.size()));
  const PatchOrder& order = context.order;
  BlockWork work;
  work.blocks = tree.leaves();
  work.run = [&](std::size_t block) {
    const SumTree::Leaf leaf = tree.leaf(block);
    const Ranks ranks(context, tasks, leaf);
    ByteWriter bytes;
    putSums(sum(leaf.begin, leaf.end), ranks.first, bytes);
    for (std::size_t k = ranks.first; k < ranks.end; ++k) {
      bytes.put(context.backs[order.patch[k]]);
      bytes.putArray(std::span<const SeenBack>(context.seen_backs[order.patch[k]]));
    }
    return std::vector<std::byte>(bytes.bytes().begin(), bytes.bytes().end());
  };
  work.take = [&](std::size_t block, std::span<const std::byte> from, int process) {
    const Ranks ranks(context, tasks, tree.leaf(block));
    ByteReader bytes(from);
    RowSums sums(order.ranked);
    takeSums(ranks.first, bytes, sums);
    for (std::size_t k = ranks.first; k < ranks.end; ++k) {
      context.backs[order.patch[k]] = bytes.get<double>();
      context.seen_backs[order.patch[k]] = bytes.getArray<SeenBack>();
    }
    tree.put(block, std::move(sums));
    if (process != 0) progress.advance(ranks.end - ranks.first);
  };
  handOut(processes, work, progress);
  RowSums none(order.ranked);
  return processes.rank() == 0 ? tree.take(std::move(none)) : std::move(none);
}

}  // namespace radiosity
