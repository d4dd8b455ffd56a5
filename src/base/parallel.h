// Parallel loops whose results do not depend on the number of threads.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_sort.h>

#include <cstddef>
#include <functional>
#include <vector>

#include "base/thread_order.h"

namespace radiosity {

/// Calls body(i) for 0 <= i < count on all threads that setThreads() allows. Bodies must write to
/// disjoint places; an exception that one throws reaches the caller.
template <class Body>
void parallelFor(std::size_t count, std::size_t grain, const Body& body) {
  const ThreadOrder order;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      const ThreadOrder::Body ordered(order);
                      for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
                    });
}

/// Calls both, in parallel if a thread is free.
template <class First, class Second>
void parallelBoth(const First& first, const Second& second) {
  const ThreadOrder order;
  const auto inOrder = [&](const auto& body) {
    const ThreadOrder::Body ordered(order);
    body();
  };
  tbb::parallel_invoke([&] { inOrder(first); }, [&] { inOrder(second); });
}

/// Sorts a vector by `less`. Different values must not compare equal, since equal ones may change
/// places.
template <class Value, class Less = std::less<Value>>
void parallelSort(std::vector<Value>& values, const Less& less = {}) {
  const ThreadOrder order;
  tbb::parallel_sort(values.begin(), values.end(), less);
}

/// The number of threads that setThreads() allows.
std::size_t allowedThreads();

}  // namespace radiosity
