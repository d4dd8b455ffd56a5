// Elements: light at points, from the solution.
#include "pipeline/stages/get_or_make.h"

namespace radiosity {

/// The key that elements must have now. Call it after solution().
StageKey Pipeline::elementsKeyNow() const {
  options_.elements.validate();
  StageKey key(keyText(options_.elements));
  key.add("solution", keyHash(results_.solution.key));
  return key;
}

/// Computes elements of some patches; they are not kept. If the file has elements, their key does
/// not fit: the observer is told why.
Elements Pipeline::elementsOf(std::span<const std::uint8_t> wanted, const StageKey& key) {
  const Stopwatch watch;
  Elements some =
      computeElements(made(results_.mesh).mesh, made(results_.materials),
                      made(results_.solution).irradiance, options_.elements, wanted, progress_);
  if (!stored_.elements.key.empty()) {
    observer_.stage(*this, {Stage::elements, StageAction::recomputed,
                            why(stored_.elements.key, key), watch.seconds()});
  }
  return some;
}

const Elements& Pipeline::elements() {
  solution();
  return getOrMake(kStage<Stage::elements>, elementsKeyNow(), [this] {
    return computedStage("elements", [&] {
      return computeElements(made(results_.mesh).mesh, made(results_.materials),
                             made(results_.solution).irradiance, options_.elements, {}, progress_);
    });
  });
}

}  // namespace radiosity
