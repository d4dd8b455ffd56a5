#include "formfactor/hemicube/hemicube_blocks.h"

#include <fmt/format.h>

#include <atomic>
#include <numeric>
#include <utility>

#include "base/figure_text.h"
#include "formfactor/hemicube/gpu_rows.h"

namespace radiosity {
namespace {

bool isSingle(const RowMatrix& matrix) { return matrix.precision() == Precision::single_precision; }

/// Columns as distances from the one before: neighbours take a byte.
template <class Value>
void putEntries(const RowMatrix& matrix, std::size_t i, ByteWriter& bytes) {
  std::vector<Index> columns;
  std::vector<Value> values;
  matrix.forRow(i, [&](Index column, double value) {
    columns.push_back(column);
    values.push_back(Value(value));  // as it is stored
  });
  bytes.putArray(std::span<const Value>(values));
  Index before = 0;
  for (const Index column : columns) {
    bytes.putVarint(column - before);
    before = column;
  }
}

template <class Value>
void takeEntries(ByteReader& bytes, std::vector<Index>& columns, std::vector<double>& values) {
  Index column = 0;
  for (const Value value : bytes.getArray<Value>()) {
    column += Index(bytes.getVarint());
    columns.push_back(column);
    values.push_back(value);
  }
}

}  // namespace

HemicubeScene::HemicubeScene(const PatchMesh& mesh, const FormFactorOptions& options)
    : rows(mesh, options), gpu(openGpuEye(options.eye, rows.scene(), mesh, rows.weights())) {
  if (options.near_exact) near_pairs.emplace(mesh, options);
}

HemicubeBlocks::HemicubeBlocks(const HemicubeRows& rows, Progress& progress)
    : rows_(rows), progress_(progress) {
  for (std::size_t i = 0; i < rows.result.fronts.size(); ++i) {
    if (!rows.scene.rows.isEmpty(i)) patches_.push_back(Index(i));
  }
}

HemicubeReport HemicubeBlocks::takeCounts() {
  HemicubeReport all;
  for (Worker& worker : workers_) all += std::exchange(worker.counts, {});
  return all;
}

HemicubeReport HemicubeBlocks::counts() {
  HemicubeReport all = takeCounts();
  all += of_others_;
  return all;
}

void HemicubeBlocks::make(std::size_t block) {
  Worker& worker = workers_.local();
  if (!worker.hemicube) worker.hemicube.emplace(rows_.scene.rows.makeHemicube());
  const std::size_t i = patches_[block];
  const HemicubeView& view = rows_.scene.rows.look(i, *worker.hemicube, worker.hidden);
  store(i, view, worker.hemicube->takeCounts());
}

/// If the device gives up, a note says why.
void HemicubeBlocks::makeByDevice(std::span<const std::size_t> blocks,
                                  const std::function<void(std::size_t)>& made) {
  if (rows_.scene.gpu == nullptr) return;
  std::vector<Index> patches;
  std::vector<std::size_t> block_of(rows_.result.fronts.size());
  for (const std::size_t block : blocks) {
    patches.push_back(patches_[block]);
    block_of[patches_[block]] = block;
  }
  std::atomic<std::size_t> drawn{0};
  const std::string problem = lookFromPatches(
      *rows_.scene.gpu, rows_.scene.rows, patches,
      [&](std::size_t i, const HemicubeView& view, const HemicubeReport& counts) {
        store(i, view, counts);
        made(block_of[i]);
        drawn.fetch_add(1, std::memory_order_relaxed);
      },
      progress_);
  const std::string& name = rows_.scene.gpu->device().name;
  std::vector<Note>& notes = rows_.result.report.notes;
  if (drawn > 0) notes.push_back({Severity::info, "hemicubes drawn by " + name});
  if (!problem.empty()) {
    notes.push_back(
        {Severity::warning,
         fmt::format("{}: {}; {} {} hemicubes were drawn by the processor", name, problem,
                     drawn > 0 ? "the other" : "all", countText(patches.size() - drawn))});
  }
}

/// Stores row i as it was seen, or with its near entries corrected. The sky of a closed one is
/// leaks: it goes without.
void HemicubeBlocks::store(std::size_t i, const HemicubeView& view, HemicubeReport counts) {
  Worker& worker = workers_.local();
  PackedRow& row = worker.row;
  FormFactors& result = rows_.result;
  const std::size_t n = result.fronts.size();
  const bool closed = rows_.closed.keeps(i, view.sky, ClosedRows::kMostLeaks);
  row.pack(view, n);
  const double sky = closed ? 0.0 : view.sky;
  double rest = closed ? 1 / (1 - view.sky) : 1.0;
  for (double& value : row.values) value *= rest;
  result.fronts[i] = rest * view.fronts;
  result.sky[i] = sky;
  if (rows_.scene.near_pairs) {
    const auto [replaced, scaled] =
        rows_.scene.near_pairs->correct(i, row, rest * view.backs + sky, closed);
    counts.near_pairs += replaced;
    counts.capped += scaled.capped ? 1 : 0;
    rest *= scaled.rest;
    result.fronts[i] = std::accumulate(row.values.begin(), row.values.end(), 0.0);
    result.sky[i] = scaled.rest * sky + scaled.sky;
  }
  rows_.matrix.setRow(i, row.columns, row.values);
  result.backs[i] = rest * view.backs;
  for (std::size_t item = n; view.backs > 0 && item < view.items.size(); ++item) {
    if (!(view.items[item] > 0)) continue;
    rows_.seen_backs[i].push_back({Index(item - n), rest * view.items[item]});
  }
  worker.of_row = counts;
}

void HemicubeBlocks::finish(std::size_t block) {
  Worker& worker = workers_.local();
  worker.counts += worker.of_row;
  replaceKnown(patches_[block], worker.row);
}

/// Puts the known entries into row i, and scales the rest. A row that is known whole is scaled to
/// its account.
void HemicubeBlocks::replaceKnown(std::size_t i, PackedRow& row) {
  const KnownEntries& known = rows_.known;
  const auto entries = known.at(i);
  FormFactors& result = rows_.result;
  const double area = rows_.matrix.area()[i];
  if (known.empty() || !(area > 0)) return;
  row.columns.clear();
  row.values.clear();
  std::vector<std::uint8_t> replaced;
  auto next = entries.begin();
  const auto addKnownBefore = [&](std::size_t end) {
    for (; next != entries.end() && next->position < end; ++next) {
      row.columns.push_back(next->position);
      row.values.push_back(next->exchange / area);
      replaced.push_back(1);
    }
  };
  const bool whole = known.rowAt(i) != nullptr;
  bool seen = false;  // known ones, from the eye
  rows_.matrix.forRow(i, [&](Index j, double value) {
    if (whole || known.rowAt(j) != nullptr) {
      seen = true;
      return;
    }
    addKnownBefore(j);
    row.columns.push_back(j);
    row.values.push_back(value);
    replaced.push_back(0);
  });
  addKnownBefore(result.fronts.size());
  const bool closed = rows_.closed.closed(i);
  if (whole) {
    const RowAccount account = known.account(i, area, closed);
    result.fronts[i] = account.fronts;
    result.backs[i] = account.backs;
    result.sky[i] = account.sky;
    rows_.seen_backs[i] = known.rowAt(i)->backs;
    // All hemicubes' rows sum to what was seen, so that closed furnaces are uniform.
    const double share = known.share(i, area);
    if (share > 0) row.scale(account.fronts / share);
  } else {
    if (!seen && entries.empty()) return;
    const PackedRow::Scaled scaled =
        row.scaleRest(replaced, result.backs[i] + result.sky[i], closed);
    result.backs[i] *= scaled.rest;
    result.sky[i] = scaled.rest * result.sky[i] + scaled.sky;
    for (SeenBack& back : rows_.seen_backs[i]) back.share *= scaled.rest;
    result.fronts[i] = std::accumulate(row.values.begin(), row.values.end(), 0.0);
  }
  rows_.matrix.setRow(i, row.columns, row.values);
}

void HemicubeBlocks::put(std::size_t block, ByteWriter& bytes) const {
  const std::size_t i = patches_[block];
  if (isSingle(rows_.matrix)) {
    putEntries<float>(rows_.matrix, i, bytes);
  } else {
    putEntries<double>(rows_.matrix, i, bytes);
  }
  bytes.put(rows_.result.fronts[i]);
  bytes.put(rows_.result.backs[i]);
  bytes.put(rows_.result.sky[i]);
  bytes.putArray(std::span<const SeenBack>(rows_.seen_backs[i]));
  bytes.put(workers_.local().of_row);
}

bool HemicubeBlocks::take(std::size_t block, ByteReader& bytes) {
  const std::size_t i = patches_[block];
  std::vector<Index> columns;
  std::vector<double> values;
  if (isSingle(rows_.matrix)) {
    takeEntries<float>(bytes, columns, values);
  } else {
    takeEntries<double>(bytes, columns, values);
  }
  const auto fronts = bytes.get<double>();
  const auto backs = bytes.get<double>();
  const auto sky = bytes.get<double>();
  std::vector<SeenBack> seen = bytes.getArray<SeenBack>();
  const auto counted = bytes.get<HemicubeReport>();
  if (!bytes.isWhole()) return false;
  rows_.matrix.setRow(i, columns, values);
  rows_.result.fronts[i] = fronts;
  rows_.result.backs[i] = backs;
  rows_.result.sky[i] = sky;
  rows_.seen_backs[i] = std::move(seen);
  rows_.closed.keeps(i, sky, 0);
  workers_.local().of_row = counted;
  return true;
}

void HemicubeBlocks::tell(BlockRange range, ByteWriter& bytes) {
  bytes.put(takeCounts());
  for (std::size_t block = range.begin; block < range.end; ++block) {
    const std::size_t i = patches_[block];
    bytes.put(rows_.result.fronts[i]);
    bytes.put(rows_.result.backs[i]);
    bytes.put(rows_.result.sky[i]);
    bytes.putArray(std::span<const SeenBack>(rows_.seen_backs[i]));
  }
}

bool HemicubeBlocks::hear(BlockRange range, ByteReader& bytes) {
  of_others_ += bytes.get<HemicubeReport>();
  for (std::size_t block = range.begin; block < range.end; ++block) {
    const std::size_t i = patches_[block];
    rows_.result.fronts[i] = bytes.get<double>();
    rows_.result.backs[i] = bytes.get<double>();
    rows_.result.sky[i] = bytes.get<double>();
    rows_.seen_backs[i] = bytes.getArray<SeenBack>();
    rows_.closed.keeps(i, rows_.result.sky[i], 0);  // another process may have found it open
  }
  return false;
}

}  // namespace radiosity
