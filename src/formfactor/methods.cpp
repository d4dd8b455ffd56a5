// The table of methods.
#include <array>
#include <stdexcept>

#include "formfactor/cut/cut_factors.h"
#include "formfactor/exact/assembly/exact_factors.h"
#include "formfactor/hemicube/hemicube_factors.h"
#include "formfactor/method.h"
#include "formfactor/rays/ray_factors.h"

namespace radiosity {
namespace {

struct MethodEntry {
  FormFactorMethod method;
  std::unique_ptr<PreparedMethod> (*prepare)(const PatchMesh&, const FormFactorOptions&);
};

constexpr std::array kEntries{MethodEntry{FormFactorMethod::exact, &prepareExact},
                              MethodEntry{FormFactorMethod::rays, &prepareRays},
                              MethodEntry{FormFactorMethod::cut, &prepareCut},
                              MethodEntry{FormFactorMethod::hemicube, &prepareHemicubes}};

}  // namespace

std::unique_ptr<PreparedMethod> prepareMethod(FormFactorMethod method, const PatchMesh& mesh,
                                              const FormFactorOptions& options) {
  FormFactorOptions used = options;
  if (!used.knowsEmitters(method)) used.exact_rows.clear();
  for (const MethodEntry& entry : kEntries) {
    if (entry.method == method) return entry.prepare(mesh, used);
  }
  throw std::logic_error("no method that computes form factors");
}

}  // namespace radiosity
