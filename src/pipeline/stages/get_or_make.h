// One way for every stage: reused from this object or the results file if its key is the one asked
// for, else made. The files of this folder have a stage each: its inputs, its key, how it is made.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

#include "base/made.h"
#include "base/processor_clock.h"
#include "pipeline/stage_key.h"
#include "radiosity/pipeline.h"

namespace radiosity {

template <class T>
bool isMadeBy(const StageKey& key, const Keyed<T>& stage) {
  return stage && stage.key == key.text();
}

/// Call it after the stages that this one is made from.
template <class T, class Make>
const T& Pipeline::getOrMake(const StageOf<T>& stage, const StageKey& key, const Make& make) {
  if (isMadeBy(key, results_.*stage.value)) return made(results_.*stage.value);
  discardFrom(stage.stage);
  if (isMadeBy(key, stored_.*stage.value)) return takeStored(stage, StageAction::reused);
  return makeAnew(stage, key, make);
}

/// Loads the matrix first if the stage is made from form factors.
template <class T, class Make>
const T& Pipeline::makeAnew(const StageOf<T>& stage, const StageKey& key, const Make& make) {
  const std::string reason = why((stored_.*stage.value).key, key);
  if (stage.from == Stage::form_factors) loadMatrix();
  const Stopwatch watch;
  results_.*stage.value = {make(), key.text()};
  (stored_.*stage.value).value.reset();
  computed(stage.stage, reason, watch.seconds());
  return made(results_.*stage.value);
}

/// Moves a stage out of the results file's; its key stays there, to say what changes later.
template <class T>
const T& Pipeline::takeStored(const StageOf<T>& stage, StageAction action) {
  Keyed<T>& stored = stored_.*stage.value;
  results_.*stage.value = {std::exchange(stored.value, std::nullopt), stored.key};
  tell(stage.stage, action, action == StageAction::reused ? source_ : "");
  return made(results_.*stage.value);
}

/// Turns an InputError of `compute` into a RunError: the scene was read without a fault, so the
/// input is not to blame.
template <class Compute>
auto computedStage(const char* name, const Compute& compute) {
  try {
    return compute();
  } catch (const InputError& error) {
    throw RunError(
        fmt::format("{} failed on a scene that was read without a fault: {}", name, error.what()));
  }
}

}  // namespace radiosity
