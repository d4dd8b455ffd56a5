#define RADIOSITY_FAR_NAMESPACE radiosity::far_scalar
#define RADIOSITY_FAR_INLINE inline
#define RADIOSITY_FAR_ATTR
#include "formfactor/exact/unoccluded/far_kernels-inl.h"

namespace radiosity {
namespace {

template <class T>
std::size_t scalarRow(FarRow<T>& row, const FarBatch<T>& batch, const RuleLimits<T>& limits) {
  return far_scalar::farRow<T>(lanes::OneLane<T>(), row, batch, limits);
}

}  // namespace

FarKernels scalarFarKernels() { return {"scalar", scalarRow<float>, scalarRow<double>}; }

}  // namespace radiosity
