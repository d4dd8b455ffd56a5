#include <algorithm>
#include <cmath>
#include <type_traits>

#include "matrix/run_row.h"
#include "matrix/triangle_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matrix/triangle_kernels_simd.cpp"
#include <hwy/foreach_target.h>
// Included after foreach_target.h, which compiles this file once per instruction set.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace radiosity::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, kSums>;
using Vector = hn::Vec<Doubles>;

constexpr std::size_t kWidth = hn::MaxLanes(Doubles());
constexpr std::size_t kVectors = kSums / kWidth;

/// The number of rows whose running sums fit in registers. Machines with vectors of 8 lanes have 32
/// registers, others 16, and half of them hold sums.
constexpr std::size_t rowsAtOnce(int bands) {
  const std::size_t sums = kWidth == kSums ? 16 : 8;
  const std::size_t rows = sums / std::size_t(bands);
  return rows >= 4 ? 4 : rows >= 2 ? 2 : 1;
}

/// The fewest places worth walking over with all rows at once.
constexpr std::size_t kShortest = 4 * kSums;
/// The most places that a group of rows walks over before the next group follows. Meanwhile x and z
/// stay in the nearest cache, and the next values are prefetched.
constexpr std::size_t kTile = 16 * kSums;
constexpr std::size_t kCacheLine = 64;  // bytes

Vector load(const double* values) { return hn::LoadU(Doubles(), values); }
Vector load(const float* values) {
  return hn::PromoteTo(Doubles(), hn::LoadU(hn::Rebind<float, Doubles>(), values));
}

/// a * b + c, rounded once on every instruction set: those without such an instruction take a
/// function for it.
Vector fusedMultiplyAdd(Vector a, Vector b, Vector c) {
#if HWY_NATIVE_FMA
  return hn::MulAdd(a, b, c);
#else
  const Doubles d;
  HWY_ALIGN double factors[2][kWidth];
  HWY_ALIGN double sums[kWidth];
  hn::Store(a, d, factors[0]);
  hn::Store(b, d, factors[1]);
  hn::Store(c, d, sums);
  for (std::size_t lane = 0; lane < kWidth; ++lane) {
    sums[lane] = std::fma(factors[0][lane], factors[1][lane], sums[lane]);
  }
  return hn::Load(d, sums);
#endif
}

/// The state of a walk along a row: the next value, and the number `left` of consecutive ones.
template <class Value>
struct Cursor {
  const Run* run = nullptr;  // the next one
  const Run* end = nullptr;
  const Value* first = nullptr;  // of the row
  const Value* values = nullptr;
  std::size_t place = 0;
  std::size_t left = 0;  // 0 at the end of the row

  bool done() const { return left == 0; }
  void pass(std::size_t count) {
    values += count;
    place += count;
    left -= count;
    while (left == 0 && run != end) {
      place += run->skip;
      left = run->count;
      ++run;
    }
  }
};

template <class Value>
Cursor<Value> startOf(const RunRow& row, std::size_t first_place) {
  const Value* values = nullptr;
  if constexpr (std::is_same_v<Value, float>) {
    values = row.floats.data();
  } else {
    values = row.doubles.data();
  }
  const Run* runs = row.runs.data();
  Cursor<Value> cursor{runs, runs + row.runs.size(), values, values, first_place, 0};
  cursor.pass(0);
  return cursor;
}

/// A walk along the rows of a block.
template <int kBands, class Value>
struct Walk {
  std::size_t rows = 0;
  Cursor<Value> cursors[kMaxRows];
  RowOperands operands;
  const double* factor = nullptr;
  HWY_ALIGN double sums[kMaxRows][kBands][kSums] = {};

  double factorOf(std::size_t r, int b) const { return factor[r * kBands + std::size_t(b)]; }
};

/// The values of lanes [first, last) of kSums, others 0; `values` is that of lane `first`.
template <class Value>
struct Lanes {
  /// Values before `row` must not be read.
  Lanes(const Value* row, const Value* values, std::size_t first, std::size_t last)
      : from_(values - (std::size_t(values - row) < first ? 0 : first)),
        first_(first),
        last_(last) {
    if (std::size_t(values - row) >= first) return;
    std::copy_n(values, kSums - first, copy_ + first);
    from_ = copy_;
  }
  Lanes(const Lanes&) = delete;
  Lanes& operator=(const Lanes&) = delete;
  bool any(std::size_t v) const { return last_ > v * kWidth && first_ < (v + 1) * kWidth; }
  Vector vector(std::size_t v) const {
    const Doubles d;
    const std::size_t begin = v * kWidth;
    const auto before = hn::FirstN(d, first_ > begin ? first_ - begin : 0);
    const auto within = hn::FirstN(d, last_ - begin);
    return hn::IfThenZeroElse(before, hn::IfThenElseZero(within, load(from_ + begin)));
  }

 private:
  Value copy_[kSums] = {};
  const Value* from_;
  std::size_t first_;
  std::size_t last_;
};

/// Walks along row r alone, up to place `stop`. All state is in local variables: with members the
/// compiler would have to assume that writing z changes them.
template <int kBands, bool kGather, bool kScatter, class Value>
void walkAlone(Walk<kBands, Value>& walk, std::size_t r, std::size_t stop) {
  const Doubles d;
  Cursor<Value> cursor = walk.cursors[r];
  if (cursor.done() || cursor.place >= stop) return;
  Vector scale[kBands];
  Vector sum[kBands][kVectors];
  for (int b = 0; b < kBands; ++b) {
    if constexpr (kScatter) scale[b] = hn::Set(d, walk.factorOf(r, b));
    for (std::size_t v = 0; v < kVectors; ++v) {
      sum[b][v] = hn::Load(d, walk.sums[r][b] + v * kWidth);
    }
  }
  const std::size_t x_stride = walk.operands.x_stride;
  const std::size_t z_stride = walk.operands.z_stride;
  const double* HWY_RESTRICT x = walk.operands.x;
  double* HWY_RESTRICT z = walk.operands.z;
  const auto add = [&](std::size_t place, std::size_t v, Vector value) HWY_ATTR {
    for (int b = 0; b < kBands; ++b) {
      if constexpr (kGather) {
        const Vector from = hn::LoadU(d, x + std::size_t(b) * x_stride + place);
        sum[b][v] = fusedMultiplyAdd(value, from, sum[b][v]);
      }
      if constexpr (kScatter) {
        double* to = z + std::size_t(b) * z_stride + place;
        hn::StoreU(fusedMultiplyAdd(value, scale[b], hn::LoadU(d, to)), d, to);
      }
    }
  };
  const auto addSome = [&](std::size_t place, const Lanes<Value>& lanes) HWY_ATTR {
    for (std::size_t v = 0; v < kVectors; ++v) {
      if (lanes.any(v)) add(place + v * kWidth, v, lanes.vector(v));
    }
  };
  while (!cursor.done() && cursor.place < stop) {
    const std::size_t end = std::min(stop, cursor.place + cursor.left);
    const Value* values = cursor.values;
    std::size_t place = cursor.place;
    if (const std::size_t lane = place % kSums; lane != 0) {
      const std::size_t last = std::min(kSums, lane + (end - place));
      addSome(place - lane, {cursor.first, values, lane, last});
      values += last - lane;
      place += last - lane;
    }
    for (; place + kSums <= end; place += kSums, values += kSums) {
      for (std::size_t v = 0; v < kVectors; ++v) {
        add(place + v * kWidth, v, load(values + v * kWidth));
      }
    }
    if (place < end) addSome(place, {cursor.first, values, 0, end - place});
    cursor.pass(end - cursor.place);
  }
  walk.cursors[r] = cursor;
  for (int b = 0; b < kBands; ++b) {
    for (std::size_t v = 0; v < kVectors; ++v) {
      hn::Store(sum[b][v], d, walk.sums[r][b] + v * kWidth);
    }
  }
}

/// Gathers and scatters for rows r to r + kRows - 1, all of which have values at the `count` places
/// from `place` on; both are multiples of kSums. Of each kSums places it handles only vector v, so
/// that all sums fit in registers.
template <std::size_t kRows, int kBands, class Value>
void walkTogether(Walk<kBands, Value>& walk, std::size_t r, std::size_t v, std::size_t place,
                  std::size_t count) {
  const Doubles d;
  const std::size_t lane = v * kWidth;
  const Value* values[kRows];
  Vector scale[kRows][kBands];
  Vector sum[kRows][kBands];
  for (std::size_t i = 0; i < kRows; ++i) {
    values[i] = walk.cursors[r + i].values + lane;
    for (int b = 0; b < kBands; ++b) {
      scale[i][b] = hn::Set(d, walk.factorOf(r + i, b));
      sum[i][b] = hn::Load(d, walk.sums[r + i][b] + lane);
    }
  }
  const std::size_t x_stride = walk.operands.x_stride;
  const std::size_t z_stride = walk.operands.z_stride;
  const double* HWY_RESTRICT x = walk.operands.x + place + lane;
  double* HWY_RESTRICT z = walk.operands.z + place + lane;
  for (std::size_t m = 0; m < count; m += kSums) {
    if (v == 0 && m * sizeof(Value) % kCacheLine == 0) {
      for (std::size_t i = 0; i < kRows; ++i) hwy::Prefetch(values[i] + m + kTile);
    }
    Vector value[kRows];
    for (std::size_t i = 0; i < kRows; ++i) value[i] = load(values[i] + m);
    for (int b = 0; b < kBands; ++b) {
      const Vector from = hn::LoadU(d, x + std::size_t(b) * x_stride + m);
      double* to = z + std::size_t(b) * z_stride + m;
      Vector handed = hn::LoadU(d, to);
      for (std::size_t i = 0; i < kRows; ++i) {
        sum[i][b] = fusedMultiplyAdd(value[i], from, sum[i][b]);
        handed = fusedMultiplyAdd(value[i], scale[i][b], handed);
      }
      hn::StoreU(handed, d, to);
    }
  }
  for (std::size_t i = 0; i < kRows; ++i) {
    for (int b = 0; b < kBands; ++b) hn::Store(sum[i][b], d, walk.sums[r + i][b] + lane);
  }
}

/// Places [first, last), multiples of kSums.
struct Stretch {
  std::size_t first = 0;
  std::size_t last = 0;
};

/// The next stretch of kShortest places or more at which all rows have values; empty if none is
/// left.
template <int kBands, class Value>
Stretch nextStretch(const Walk<kBands, Value>& walk) {
  Cursor<Value> ahead[kMaxRows];
  std::copy_n(walk.cursors, walk.rows, ahead);
  const auto endOf = [](const Cursor<Value>& cursor) { return cursor.place + cursor.left; };
  for (;;) {
    std::size_t first = 0;
    Cursor<Value>* ends_first = &ahead[0];
    for (std::size_t r = 0; r < walk.rows; ++r) {
      if (ahead[r].done()) return {};
      first = std::max(first, ahead[r].place);
      if (endOf(ahead[r]) < endOf(*ends_first)) ends_first = &ahead[r];
    }
    const Stretch found = {(first + kSums - 1) / kSums * kSums, endOf(*ends_first) / kSums * kSums};
    if (found.first + kShortest <= found.last) return found;
    ends_first->pass(ends_first->left);
  }
}

/// Walks along all rows together where all have values, and one after the other elsewhere. Each
/// place adds the values scattered to it in the order of rows; each row adds the values gathered in
/// the order of places.
template <int kBands, class Value>
void walkBlock(Walk<kBands, Value>& walk) {
  constexpr std::size_t kRows = rowsAtOnce(kBands);
  const auto allAlone = [&](std::size_t stop) {
    for (std::size_t r = 0; r < walk.rows; ++r) walkAlone<kBands, true, true>(walk, r, stop);
  };
  while (walk.rows == kMaxRows) {
    const Stretch stretch = nextStretch(walk);
    if (stretch.first == stretch.last) break;
    allAlone(stretch.first);
    for (std::size_t place = stretch.first; place < stretch.last; place += kTile) {
      const std::size_t count = std::min(kTile, stretch.last - place);
      for (std::size_t r = 0; r < kMaxRows; r += kRows) {
        for (std::size_t v = 0; v < kVectors; ++v) walkTogether<kRows>(walk, r, v, place, count);
      }
      for (std::size_t r = 0; r < kMaxRows; ++r) walk.cursors[r].pass(count);
    }
  }
  allAlone(std::size_t(-1));
}

template <int kBands, bool kGather, bool kScatter, class Value>
void walkRows(const RowBlock& block, const RowOperands& operands, const double* factor,
              double* sums) {
  Walk<kBands, Value> walk;
  walk.rows = block.rows.size();
  walk.operands = operands;
  walk.factor = factor;
  for (std::size_t r = 0; r < walk.rows; ++r) {
    walk.cursors[r] = startOf<Value>(block.rows[r], block.first + r);
  }
  if constexpr (kGather && kScatter) {
    walkBlock(walk);
  } else {
    for (std::size_t r = 0; r < walk.rows; ++r) {
      walkAlone<kBands, kGather, kScatter>(walk, r, std::size_t(-1));
    }
  }
  if constexpr (!kGather) return;
  for (std::size_t r = 0; r < walk.rows; ++r) {
    for (int b = 0; b < kBands; ++b) {
      const double* s = walk.sums[r][b];
      sums[r * kBands + std::size_t(b)] =
          ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]));
    }
  }
}

template <int kBands, bool kGather, bool kScatter>
void walkValues(const RowBlock& block, const RowOperands& operands, const double* factor,
                double* sums) {
  // A row without values has neither floats nor doubles.
  const bool doubles = std::any_of(block.rows.begin(), block.rows.end(),
                                   [](const RunRow& row) { return !row.doubles.empty(); });
  if (doubles) {
    walkRows<kBands, kGather, kScatter, double>(block, operands, factor, sums);
  } else {
    walkRows<kBands, kGather, kScatter, float>(block, operands, factor, sums);
  }
}

template <bool kGather, bool kScatter>
void walkBands(const RowBlock& block, const RowOperands& operands, const double* factor,
               double* sums) {
  switch (operands.bands) {
    case 1:
      return walkValues<1, kGather, kScatter>(block, operands, factor, sums);
    case 2:
      return walkValues<2, kGather, kScatter>(block, operands, factor, sums);
    case 3:
      return walkValues<3, kGather, kScatter>(block, operands, factor, sums);
    default:
      return walkValues<kMaxBands, kGather, kScatter>(block, operands, factor, sums);
  }
}

void gather(const RowBlock& block, const RowOperands& operands, double* sums) {
  walkBands<true, false>(block, operands, nullptr, sums);
}

void scatter(const RowBlock& block, const RowOperands& operands, const double* factor) {
  walkBands<false, true>(block, operands, factor, nullptr);
}

void gatherAndScatter(const RowBlock& block, const RowOperands& operands, const double* factor,
                      double* sums) {
  walkBands<true, true>(block, operands, factor, sums);
}

TriangleKernels kernels() {
  return {hwy::TargetName(HWY_TARGET), gather, scatter, gatherAndScatter};
}

}  // namespace
}  // namespace radiosity::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace radiosity {

HWY_EXPORT(kernels);

TriangleKernels triangleKernels() { return HWY_DYNAMIC_DISPATCH(kernels)(); }

}  // namespace radiosity
#endif
