// Rows of hemicubes, a block each.
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "formfactor/closed_rows.h"
#include "formfactor/hemicube/gpu_eye.h"
#include "formfactor/hemicube/near_pairs.h"
#include "formfactor/hemicube/row_builder.h"
#include "formfactor/known_entries.h"
#include "formfactor/row_accounts.h"
#include "formfactor/row_blocks.h"
#include "radiosity/row_matrix.h"

namespace radiosity {

/// The scene as all rows see it.
struct HemicubeScene {
  /// Keeps `mesh` by reference. Throws RunError as openGpuEye().
  HemicubeScene(const PatchMesh& mesh, const FormFactorOptions& options);
  RowBuilder rows;
  std::unique_ptr<GpuEye> gpu;          ///< null: the CPU's eye looks
  std::optional<NearPairs> near_pairs;  ///< if near entries are to be made exact
};

/// What rows are made from, and the places that they are stored in.
struct HemicubeRows {
  const HemicubeScene& scene;
  const KnownEntries& known;  ///< by patch
  ClosedRows& closed;
  RowMatrix& matrix;
  FormFactors& result;  ///< its accounts, N each, and notes
  std::vector<std::vector<SeenBack>>& seen_backs;
};

/// A block a patch that sees anything. A journal keeps what was seen, to which known entries, which
/// may be others in the next run, are not put yet. Rows stay in the process that makes them;
/// process 0 gets their accounts and counts.
class HemicubeBlocks final : public RowBlocks {
 public:
  HemicubeBlocks(const HemicubeRows& rows, Progress& progress);

  /// Of all rows, once they are made. In process 0.
  HemicubeReport counts();

  std::size_t count() const override { return patches_.size(); }
  void make(std::size_t block) override;
  void makeByDevice(std::span<const std::size_t> blocks,
                    const std::function<void(std::size_t)>& made) override;
  void finish(std::size_t block) override;
  RowBlock kind() const override { return RowBlock::row; }
  std::uint64_t number(std::size_t block) const override { return patches_[block]; }
  void put(std::size_t block, ByteWriter& bytes) const override;
  bool take(std::size_t block, ByteReader& bytes) override;
  bool rowsStay() const override { return true; }
  void tell(BlockRange range, ByteWriter& bytes) override;
  bool hear(BlockRange range, ByteReader& bytes) override;

 private:
  /// What a thread holds.
  struct Worker {
    std::optional<Hemicube> hemicube;
    std::vector<std::uint8_t> hidden;
    PackedRow row;
    HemicubeReport of_row;  ///< the last
    HemicubeReport counts;  ///< since takeCounts()
  };
  void store(std::size_t i, const HemicubeView& view, HemicubeReport counts);
  void replaceKnown(std::size_t i, PackedRow& row);
  HemicubeReport takeCounts();

  HemicubeRows rows_;
  Progress& progress_;
  std::vector<Index> patches_;
  HemicubeReport of_others_;
  mutable tbb::enumerable_thread_specific<Worker> workers_;
};

}  // namespace radiosity
