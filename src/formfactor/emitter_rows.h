// The rows of patches that emit, beside which rays or hemicubes make all others.
#pragma once

#include <memory>
#include <optional>

#include "formfactor/exact/assembly/leading_rows.h"
#include "formfactor/method.h"
#include "formfactor/rays/shadow_rows.h"

namespace radiosity {

/// They are exact, or, where that is too much work, by shadow rays.
class EmitterRows {
 public:
  /// Prepares the rows of FormFactorOptions::exact_rows beside `method`, and adds what they take to
  /// its plan. Null if there are none, the method takes none, or they are too much work beside it.
  /// `mesh` is kept by reference.
  static std::unique_ptr<const EmitterRows> planned(const PatchMesh& mesh,
                                                    const FormFactorOptions& options,
                                                    const PreparedMethod& method,
                                                    FormFactorPlan& plan, Progress& progress);

  bool areExact() const { return exact_.has_value(); }
  double secondsPreparing() const { return seconds_; }
  KnownRows compute(Progress& progress) const;

 private:
  struct Room;
  bool planExact(const Room& room, Progress& progress);
  bool planShadows(const Room& room, Progress& progress);

  std::optional<LeadingRows> exact_;
  std::optional<ShadowRows> by_shadows_;
  double seconds_ = 0;  ///< for preparing these
};

}  // namespace radiosity
