#include "formfactor/exact/assembly/leading_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "formfactor/exact/assembly/row_assembly.h"
#include "formfactor/exact/assembly/task_blocks.h"
#include "formfactor/exact/error_model.h"
#include "formfactor/wanted_rows.h"
#include "matrix/run_row.h"
#include "matrix/uncertain_row.h"

namespace radiosity {

/// Rows of the triangle between patches.
struct LeadingRows::Triangle {
  Triangle(const PatchMesh& mesh, const PatchOrder& order)
      : matrix(mesh.area, order.patch, Precision::double_precision),
        uncertain(mesh.size()),
        backs(mesh.size(), 0.0),
        seen_backs(mesh.size()) {}

  SymmetricMatrix matrix;
  UncertainEntries uncertain;
  std::vector<double> backs;
  std::vector<std::vector<SeenBack>> seen_backs;
};

namespace {

/// Places of a sample, and the seconds for which their pairs are clipped: less than of all rows,
/// since these rows are a small part of the work.
constexpr std::size_t kLeadingSteps = 24;
constexpr double kLeadingClipSeconds = 0.06;
/// Occluded pairs that are all evaluated again; of more, no more than these or than one in
/// kRecheckMost: it takes some times as long, and past a forest of columns seconds.
constexpr double kRecheckAll = 256;
constexpr double kRecheckMost = 16;

std::vector<std::uint8_t> flagsOf(std::span<const Index> wanted, std::size_t patches) {
  std::vector<std::uint8_t> flags(patches, 0);
  for (const Index i : wanted) flags[i] = 1;
  return flags;
}

/// Errors of F of a row's occluded pairs, by position; 0 elsewhere.
void readErrors(const UncertainEntries& uncertain, std::size_t k, std::vector<double>& errors) {
  std::fill(errors.begin(), errors.end(), 0.0);
  const UncertainEntries::Row& row = uncertain.row(k);
  forRuns(std::span(row.runs), row.codes.data(),
          [&](std::size_t offset, const std::uint8_t* codes, std::size_t count) {
            for (std::size_t m = 0; m < count; ++m) {
              errors[k + 1 + offset + m] = errorOfCode(codes[m]);
            }
          });
}

}  // namespace

LeadingRows::LeadingRows(const PatchMesh& mesh, std::vector<Index> wanted,
                         const FormFactorOptions& options, Progress& progress)
    : mesh_(mesh),
      wanted_(std::move(wanted)),
      options_(options),
      scene_(mesh, progress, flagsOf(wanted_, mesh.size())) {}

RowSample LeadingRows::sample(Progress& progress) const {
  RowSample sample;
  samplePairs(scene_, scene_.leadingTasks(), kLeadingSteps, sample, progress);
  return sample;
}

double LeadingRows::work(RowSample& sample) {
  const double tolerance = options_.toleranceOf(FormFactorMethod::exact);
  foreseeCost(scene_, tolerance, sample);
  const ExactEstimate estimate = estimateExact(scene_, sample, options_);
  const double pairs = estimate.occluded_pairs;
  recheck_every_ = std::max(recheckEvery(pairs, tolerance),
                            std::size_t(std::min(kRecheckMost, pairs / kRecheckAll)));
  return estimate.work;
}

double LeadingRows::seconds(const RowSample& sample, Progress& progress) const {
  // There are often fewer tasks than threads.
  const double threads = double(allowedThreads());
  const double busy = std::min(threads, double(std::max<std::size_t>(scene_.leadingTasks(), 1)));
  return threads / busy *
         exactSeconds(scene_, ExactKernels(scene_, options_), sample, options_, kLeadingClipSeconds,
                      progress);
}

std::size_t LeadingRows::bytes() const {
  constexpr std::size_t kElementBytes = 512;  // as estimateExact()
  return scene_.elements.size() * kElementBytes + WantedRows::bytes(wanted_.size(), mesh_.size()) +
         allowedThreads() * scene_.tasks.panelBytes(scene_.elements);
}

double LeadingRows::fill(Triangle& triangle, const ExactKernels& kernels,
                         Progress& progress) const {
  const Emitters emitters(mesh_, scene_.order, wanted_);
  const RowContext context{scene_.elements,    scene_.order,        scene_.chunks,
                           scene_.visibility,  kernels.unoccluded,  kernels.occluded,
                           progress,           recheck_every_,      &emitters,
                           triangle.matrix,    &triangle.uncertain, triangle.backs,
                           triangle.seen_backs};
  TaskBlocks blocks(context, scene_.tasks, scene_.leadingTasks());
  std::size_t rows = 0;
  for (std::size_t block = 0; block < blocks.count(); ++block) rows += blocks.steps(block);
  progress.begin("form factors of emitters", rows);
  makeBlocks(blocks, RowRun{progress});
  progress.end();
  return blocks.sums().error.raise();
}

std::vector<KnownRow> LeadingRows::compute(Progress& progress) const {
  const std::size_t tasks = scene_.leadingTasks();
  if (tasks == 0) return {};
  const ExactKernels kernels(scene_, options_);
  const PatchOrder& order = scene_.order;
  Triangle triangle(mesh_, order);
  const double raise = fill(triangle, kernels, progress);
  WantedRows rows(mesh_.size(), wanted_);
  const double closed_forms = kRowClosedForms * kernels.closed_form;
  std::vector<double> errors(mesh_.size());
  const std::size_t last = order.rank[scene_.tasks[tasks - 1].back().end - 1];
  for (std::size_t k = 0; k <= last; ++k) {
    const Index patch = order.patch[k];
    const double area = mesh_.area[patch];
    readErrors(triangle.uncertain, k, errors);
    forRuns(triangle.matrix.upperRuns(k), [&](std::size_t offset, const auto* values,
                                              std::size_t count) {
      for (std::size_t m = 0; m < count; ++m) {
        const std::size_t other = k + 1 + offset + m;
        const double factor = double(values[m]);
        const double error = errors[other] > 0 ? raise * errors[other] : closed_forms * factor;
        rows.add(patch, order.patch[other], area * factor, area * error);
      }
    });
    rows.addBacks(patch, triangle.seen_backs[patch]);
  }
  return rows.take();
}

}  // namespace radiosity
