#include "formfactor/row_memory.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/figure_text.h"
#include "matrix/expected_bytes.h"

namespace radiosity {

namespace {

/// The least of scratch memory to keep in memory: with less, every step runs at the disk's speed.
constexpr std::size_t kLeastResident = std::size_t(1) << 24;
/// Resident rows are in memory three times at most: panels copy them, and other threads look at
/// more of them before all are released.
constexpr std::size_t kTimesResident = 3;

}  // namespace

RowMemory planRowMemory(std::size_t whole, std::size_t beside, std::size_t rows,
                        const FormFactorOptions& options) {
  RowMemory memory;
  memory.bytes = whole;
  const std::size_t limit = options.memory_limit;
  if (limit == 0 || memory.bytes <= limit || options.scratch_folder.empty()) return memory;
  const std::size_t left = limit > beside ? limit - beside : 0;
  const std::size_t resident = std::max(kLeastResident, left / kTimesResident);
  // The disk is no help if the rows are hardly more than their part in memory.
  if (kTimesResident * resident >= rows) return memory;
  memory.bytes = beside + kTimesResident * resident;
  memory.scratch_bytes = rows;
  memory.resident = resident;
  return memory;
}

RowMemory shareOf(const RowMemory& memory, std::size_t matrix_bytes, int processes) {
  const bool on_disk = memory.scratch_bytes > 0;
  const std::size_t rows = on_disk ? memory.scratch_bytes : matrix_bytes;
  const std::size_t held = on_disk ? kTimesResident * memory.resident : matrix_bytes;
  const std::size_t beside = memory.bytes > held ? memory.bytes - held : 0;
  return {.bytes = beside + rows / std::size_t(processes)};
}

std::size_t panelsOf(std::size_t matrix_bytes, Precision precision) {
  // Panels hold both entries of a pair, the matrix one.
  const std::size_t entries = 2 * matrix_bytes / valueBytes(precision);
  return std::min(ExchangeMatrix::panelBytes(matrix_bytes), entries * RowPanel::kEntryBytes);
}

std::shared_ptr<ScratchMemory> makeRowMemory(const RowMemory& memory,
                                             const FormFactorOptions& options,
                                             std::size_t patches) {
  if (options.memory_limit > 0 && memory.bytes > options.memory_limit) {
    throw RunError(fmt::format(
        "form factors of {} patches need about {}{}, more than the limit of {}; mesh with fewer "
        "patches, use single precision or raise the limit",
        patches, bytesText(memory.bytes),
        memory.scratch_bytes > 0 ? " beside the rows, which would be on the disk" : "",
        bytesText(options.memory_limit)));
  }
  if (memory.scratch_bytes == 0) return nullptr;
  return std::make_shared<ScratchMemory>(options.scratch_folder, memory.resident);
}

}  // namespace radiosity
