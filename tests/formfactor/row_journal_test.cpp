// Form factors that go on from rows of an earlier run: the same bits, whatever is missing.
#include "radiosity/row_journal.h"

#include <gtest/gtest.h>

#include <bit>
#include <cctype>
#include <map>
#include <memory>
#include <mutex>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "radiosity/exchange_matrix.h"
#include "radiosity/form_factors.h"
#include "support/mesh_builder.h"

namespace radiosity {
namespace {

/// In memory; ends a run after some blocks, as a signal would.
class MemoryJournal : public RowJournal {
 public:
  using Name = std::pair<RowBlock, std::uint64_t>;
  using Bytes = std::vector<std::byte>;

  bool has(RowBlock kind, std::uint64_t number) const override {
    return there.contains({kind, number});
  }
  Bytes kept(RowBlock kind, std::uint64_t number) const override {
    const auto found = there.find({kind, number});
    return found == there.end() ? Bytes() : found->second;
  }
  void keep(RowBlock kind, std::uint64_t number, std::span<const std::byte> bytes) override {
    const std::lock_guard lock(mutex_);
    written[{kind, number}].assign(bytes.begin(), bytes.end());
    ++writes;
    if (writes == most_) progress->cancel();
  }
  void found(std::size_t rows, std::size_t of) override {
    rows_found = rows;
    rows_at_all = of;
  }
  /// The next run finds all written blocks but a share drawn at random.
  void reopen(double lost = 0) {
    std::mt19937 random(7);
    for (auto& [name, bytes] : written) {
      if (double(random()) >= lost * 0x1p32) there[name] = bytes;
    }
    written.clear();
    writes = 0;
  }

  /// For another run, which ends after `most` blocks.
  void renew(std::size_t most) {
    progress = std::make_unique<Progress>();
    most_ = most;
  }

  std::map<Name, Bytes> there;
  std::map<Name, Bytes> written;
  std::size_t writes = 0;
  std::size_t rows_found = 0;
  std::size_t rows_at_all = 0;
  std::unique_ptr<Progress> progress = std::make_unique<Progress>();

 private:
  std::size_t most_ = std::size_t(-1);
  std::mutex mutex_;
};

using Bits = std::vector<std::uint64_t>;

void add(std::span<const double> values, Bits& bits) {
  for (const double value : values) bits.push_back(std::bit_cast<std::uint64_t>(value));
}

/// All results but the seconds.
Bits bitsOf(const FormFactors& factors) {
  Bits bits;
  const std::size_t n = factors.matrix->size();
  for (std::size_t i = 0; i < n; ++i) {
    pairsOf(*factors.matrix).forRow(i, [&](Index column, double value) {
      bits.push_back(column);
      add({&value, 1}, bits);
    });
  }
  add(factors.fronts, bits);
  add(factors.backs, bits);
  add(factors.sky, bits);
  add(factors.backs_by_surface, bits);
  add(factors.error, bits);
  const FormFactorReport& report = factors.report;
  const ExactReport& exact = report.exact;
  const RayReport& rays = report.rays;
  for (const std::size_t count :
       {exact.no_exchange, exact.unoccluded, exact.hidden, exact.occluded, exact.shaft_tests,
        exact.points, exact.contour, exact.rechecked, rays.rays, std::size_t(rays.rounds),
        rays.short_rows, rays.leaked, report.hemicube.hemicubes, report.hemicube.pixels,
        report.hemicube.rasterised_polygons, report.hemicube.near_pairs, report.matrix_bytes}) {
    bits.push_back(count);
  }
  for (const double figure : {report.error_figure, report.largest_row_error,
                              report.reciprocity_residual, exact.recheck_ratio}) {
    add({&figure, 1}, bits);
  }
  bits.push_back(report.closed ? 1 : 0);
  return bits;
}

struct JournalCase {
  const char* name;
  FormFactorOptions options;
};

std::vector<JournalCase> journalCases() {
  std::vector<JournalCase> all;
  FormFactorOptions options;
  options.method = FormFactorMethod::exact;
  all.push_back({"exact", options});
  options.closure = ClosureMode::enforce;
  options.tolerance = 9e-7;  // double precision
  all.push_back({"exact, closed, double", options});
  options = {};
  options.method = FormFactorMethod::hemicube;
  options.resolution = 64;
  all.push_back({"hemicube", options});
  options.symmetrize = true;
  options.near_exact = true;
  options.exact_rows = {0, 5, 11};
  options.precision = Precision::double_precision;
  all.push_back({"hemicube, symmetric, near, exact rows, double", options});
  options = {};
  options.method = FormFactorMethod::rays;
  options.tolerance = 1e-2;
  all.push_back({"rays", options});
  return all;
}

/// A room with a block in it, of which a surface is seen from behind.
PatchMesh room() { return test::roomWithBlock(3).build(); }

class Journal : public testing::TestWithParam<JournalCase> {
 protected:
  FormFactors computed(MemoryJournal* journal) const {
    Progress silent;
    const FormFactorPlan plan = planFormFactors(mesh_, GetParam().options, silent);
    return computeFormFactors(plan, journal != nullptr ? *journal->progress : silent, journal);
  }
  PatchMesh mesh_ = room();
};

TEST_P(Journal, ChangesNoBit) {
  const Bits plain = bitsOf(computed(nullptr));
  MemoryJournal journal;
  EXPECT_EQ(bitsOf(computed(&journal)), plain);
  EXPECT_EQ(journal.rows_found, 0u);
  EXPECT_GT(journal.writes, 0u);
  journal.reopen();
  EXPECT_EQ(bitsOf(computed(&journal)), plain) << "all of it from the journal";
  EXPECT_EQ(journal.rows_found, journal.rows_at_all);
  EXPECT_EQ(journal.rows_at_all, mesh_.size());
}

TEST_P(Journal, EndedRunsResumeToTheSameBits) {
  const Bits plain = bitsOf(computed(nullptr));
  MemoryJournal whole;
  computed(&whole);
  const std::size_t blocks = whole.writes;
  MemoryJournal journal;
  std::size_t ended = 0;
  // Each run gets a fifth further, and one in five of its blocks is damaged.
  for (; ended < 4; ++ended) {
    journal.renew(blocks / 5);
    EXPECT_THROW(computed(&journal), Cancelled);
    journal.reopen(0.2);
  }
  journal.renew(std::size_t(-1));
  EXPECT_EQ(bitsOf(computed(&journal)), plain);
  EXPECT_GT(journal.rows_found, 0u);
  EXPECT_LT(journal.writes, blocks) << "rows that were there are not computed again";
}

TEST_P(Journal, MissingBlocksAreComputedAgain) {
  const Bits plain = bitsOf(computed(nullptr));
  MemoryJournal journal;
  computed(&journal);
  const auto all = journal.written;
  for (const double lost : {0.02, 0.3, 0.9}) {
    journal.written = all;
    journal.there.clear();
    journal.reopen(lost);
    EXPECT_EQ(bitsOf(computed(&journal)), plain) << lost;
    EXPECT_LT(journal.writes, all.size()) << "blocks that were there are not computed again";
  }
}

TEST_P(Journal, BlocksOfAnotherSizeChangeNoBit) {
  const Bits plain = bitsOf(computed(nullptr));
  MemoryJournal journal;
  computed(&journal);
  journal.reopen();
  for (auto& [name, bytes] : journal.there) bytes.resize(bytes.size() - 1);
  EXPECT_EQ(bitsOf(computed(&journal)), plain) << "cut";
  journal.reopen();
  for (auto& [name, bytes] : journal.there) bytes.push_back({});
  EXPECT_EQ(bitsOf(computed(&journal)), plain) << "longer";
}

INSTANTIATE_TEST_SUITE_P(Methods, Journal, testing::ValuesIn(journalCases()),
                         [](const auto& method) {
                           std::string name = method.param.name;
                           std::erase_if(name, [](char c) {
                             return std::isalnum(static_cast<unsigned char>(c)) == 0;
                           });
                           return name;
                         });

}  // namespace
}  // namespace radiosity
