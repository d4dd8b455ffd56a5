// What a method of form factors is: a mesh prepared for it, the plan, the rows. Each has a folder
// of its own and an entry in methods.cpp; what others need to know of it stands in
// radiosity/form_factor_method.h.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "formfactor/known_rows.h"
#include "formfactor/row_blocks.h"
#include "formfactor/row_memory.h"
#include "radiosity/exchange_matrix.h"
#include "radiosity/form_factors.h"

namespace radiosity {

/// Rows of those that emit, beside which a method makes all others.
struct KnownRows {
  std::vector<KnownRow> rows;
  bool are_exact = true;  ///< or by shadow rays
  double seconds = 0;     ///< for preparing and making them
};

/// What exact rows may take beside a method that can do with them.
struct RoomForExactRows {
  double work = 0;        ///< at most (foreseen_work.h)
  std::size_t bytes = 0;  ///< held by others while they are made
};

/// A mesh prepared for one method.
class PreparedMethod {
 public:
  /// `mesh` is kept by reference.
  PreparedMethod(FormFactorMethod method, const PatchMesh& mesh, const FormFactorOptions& options)
      : mesh_(mesh), options_(options), traits_(traitsOf(method)) {}
  virtual ~PreparedMethod() = default;
  PreparedMethod(const PreparedMethod&) = delete;
  PreparedMethod& operator=(const PreparedMethod&) = delete;

  /// Prepares the mesh and foresees the cost; a second call goes on where the first was Cancelled.
  FormFactorPlan plan(Progress& progress);
  /// Computes what was planned, any number of times. `journal` and `processes` may be null; of
  /// `processes` the others are in computeForOthers().
  FormFactors compute(KnownRows known, Progress& progress, RowJournal* journal,
                      Processes* processes) const;
  /// The rows that fall to this process while process 0 is in compute(). Needs no plan.
  std::shared_ptr<const ExchangeMatrix> computeForOthers(Processes& processes, Progress& progress,
                                                         RowJournal* journal) const;

  /// Seconds of plan() for what compute() needs.
  double secondsPreparing() const { return seconds_preparing_; }
  /// Of a method that was planned; nothing if it takes no known rows.
  virtual std::optional<RoomForExactRows> roomForExactRows() const { return std::nullopt; }

 protected:
  const PatchMesh& mesh() const { return mesh_; }
  const FormFactorOptions& options() const { return options_; }
  double tolerance() const { return options_.toleranceOf(traits_.method); }
  /// Seconds and tolerance of the rows, the memory in which they are made and, of that, the
  /// matrix.
  struct Cost {
    FormFactorPlan plan;
    RowMemory memory;
  };
  double seconds_preparing_ = 0;

 private:
  virtual Cost foresee(Progress& progress) = 0;
  virtual FormFactors make(KnownRows known, const RowRun& run) const = 0;
  virtual std::shared_ptr<const ExchangeMatrix> share(const RowRun& run) const = 0;
  /// As foreseen; of several processes, that of process 0 where rows stay with those that make
  /// them.
  RowMemory memory(const Processes* processes) const;

  const PatchMesh& mesh_;
  FormFactorOptions options_;
  const MethodTraits& traits_;
  RowMemory memory_;
  std::size_t matrix_bytes_ = 0;
};

/// `method`: one that can be asked for, and not automatic. `mesh` is kept by reference.
std::unique_ptr<PreparedMethod> prepareMethod(FormFactorMethod method, const PatchMesh& mesh,
                                              const FormFactorOptions& options);

}  // namespace radiosity
