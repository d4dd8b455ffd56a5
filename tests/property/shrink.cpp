#include "shrink.h"

#include <algorithm>
#include <chrono>

#include "checks.h"

namespace radiosity::property {

namespace {

using Clock = std::chrono::steady_clock;

bool fails(const Model& model, const std::string& what, const std::string& path) {
  model.write(path);
  const Findings findings = check(model, path);
  return std::any_of(findings.faults.begin(), findings.faults.end(),
                     [&](const Fault& fault) { return fault.what == what; });
}

/// Part and place in it of face number `face`.
void dropFace(Model& model, std::size_t face) {
  for (Part& part : model.parts) {
    if (face < part.faces.size()) {
      part.faces.erase(part.faces.begin() + std::ptrdiff_t(face));
      return;
    }
    face -= part.faces.size();
  }
}

}  // namespace

Model shrunk(Model model, const std::string& what, const std::string& path, double seconds) {
  const Clock::time_point end = Clock::now() + std::chrono::milliseconds(long(1e3 * seconds));
  // Without a face the scene is another: what its making told holds no more.
  const bool by_making = model.known.closed == false || model.known.sky_area || model.known.factor;
  bool smaller = !by_making;
  while (smaller) {
    smaller = false;
    for (std::size_t face = model.faceCount(); face-- > 0;) {
      if (Clock::now() > end) return model;
      Model trial = model;
      dropFace(trial, face);
      if (trial.faceCount() == 0 || !fails(trial, what, path)) continue;
      model = std::move(trial);
      smaller = true;
    }
  }
  while (model.patches > 1 && Clock::now() < end) {
    Model trial = model;
    trial.patches /= 2;
    if (!fails(trial, what, path)) break;
    model = std::move(trial);
  }
  return model;
}

}  // namespace radiosity::property
