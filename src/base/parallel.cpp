#include "base/parallel.h"

#include <tbb/global_control.h>

#include <memory>

#include "radiosity/base.h"

namespace radiosity {

void setThreads(int threads) {
  static std::unique_ptr<tbb::global_control> control;
  control.reset();
  if (threads > 0) {
    control = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                    std::size_t(threads));
  }
}

std::size_t allowedThreads() {
  return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

}  // namespace radiosity
