// The journal of rows as a file: the blocks read back after a run was ended in any way.
#include "pipeline/journal_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numeric>

#include "support/results_folder.h"

namespace radiosity {
namespace {

constexpr RowBlock kKind = RowBlock::row;
constexpr std::size_t kBlocks = 20;

/// Of many lengths, no two alike.
std::vector<std::byte> block(std::size_t number) {
  std::vector<std::byte> bytes(1 + 37 * number);
  for (std::size_t k = 0; k < bytes.size(); ++k) bytes[k] = std::byte(k * 31 + number);
  return bytes;
}

class JournalOnDisk : public FolderTest {
 protected:
  JournalFile opened(const std::string& key = "key=1", bool resume = true) const {
    return {file(), key, resume};
  }
  std::string file() const { return path("out.h5.rows"); }
  void keepAll() const {
    JournalFile journal = opened();
    for (std::size_t k = 0; k < kBlocks; ++k) journal.keep(kKind, k, block(k));
  }
  /// Blocks that are read back unchanged; no other may be read back.
  std::size_t goodBlocks(const JournalFile& journal) const {
    std::size_t good = 0;
    for (std::size_t k = 0; k < kBlocks; ++k) {
      EXPECT_EQ(journal.has(kKind, k), !journal.kept(kKind, k).empty());
      if (!journal.has(kKind, k)) continue;
      EXPECT_EQ(journal.kept(kKind, k), block(k)) << k;
      ++good;
    }
    return good;
  }
};

TEST_F(JournalOnDisk, BlocksAreReadBack) {
  keepAll();
  EXPECT_EQ(JournalFile::keyIn(file()), "key=1");
  const JournalFile journal = opened();
  EXPECT_EQ(journal.atOpening().blocks, kBlocks);
  EXPECT_EQ(journal.atOpening().damaged, 0u);
  EXPECT_EQ(goodBlocks(journal), kBlocks);
  EXPECT_FALSE(journal.has(RowBlock::ray_row, 0));
  EXPECT_TRUE(journal.kept(RowBlock::ray_row, 0).empty());
}

TEST_F(JournalOnDisk, TheLaterOfTwoBlocksCounts) {
  {
    JournalFile journal = opened();
    journal.keep(kKind, 3, block(5));
    journal.keep(kKind, 3, block(3));
  }
  EXPECT_EQ(opened().kept(kKind, 3), block(3));
}

TEST_F(JournalOnDisk, WholeBlocksSurviveAnyTruncation) {
  keepAll();
  const std::vector<char> whole = load(file());
  std::size_t before = 0;
  for (std::size_t size = 48; size <= whole.size(); size += 17) {
    save(file(), {whole.begin(), whole.begin() + std::ptrdiff_t(size)});
    std::size_t good = 0;
    {
      JournalFile journal = opened();
      good = goodBlocks(journal);
      EXPECT_GE(good, before);
      EXPECT_LE(journal.atOpening().damaged, 1u);
      journal.keep(kKind, kBlocks - 1, block(kBlocks - 1));
    }
    const JournalFile again = opened();
    EXPECT_EQ(again.atOpening().damaged, 0u) << "what is added takes the place of the cut block";
    EXPECT_EQ(goodBlocks(again), good + (good == kBlocks ? 0 : 1));
    before = good;
  }
  EXPECT_GE(before, kBlocks - 1);
}

TEST_F(JournalOnDisk, AChangedByteCostsOneBlock) {
  keepAll();
  const std::vector<char> whole = load(file());
  const std::size_t header = 32 + 8;
  for (std::size_t at = header; at < whole.size(); at += 13) {
    std::vector<char> changed = whole;
    changed[at] = char(changed[at] ^ 0x10);
    save(file(), changed);
    const JournalFile journal = opened();
    const std::size_t good = goodBlocks(journal);
    EXPECT_GE(good, kBlocks - 1) << at;
    if (good < kBlocks) {
      EXPECT_GE(journal.atOpening().damaged, 1u) << at;
    }
  }
}

TEST_F(JournalOnDisk, AnotherKeyStartsAfresh) {
  keepAll();
  {
    const JournalFile journal = opened("key=2");
    EXPECT_TRUE(journal.atOpening().other_key);
    EXPECT_EQ(goodBlocks(journal), 0u);
  }
  EXPECT_EQ(files(), 0u) << "nothing was kept in it";
}

TEST_F(JournalOnDisk, NoResumeStartsAfresh) {
  keepAll();
  const JournalFile journal = opened("key=1", false);
  EXPECT_FALSE(journal.atOpening().other_key);
  EXPECT_EQ(goodBlocks(journal), 0u);
}

TEST_F(JournalOnDisk, AChangedHeaderIsAnotherKey) {
  keepAll();
  const std::vector<char> whole = load(file());
  for (const std::size_t at :
       {std::size_t(8), std::size_t(12), std::size_t(16), std::size_t(24), std::size_t(33)}) {
    std::vector<char> changed = whole;
    changed[at] = char(changed[at] ^ 0x01);
    save(file(), changed);
    EXPECT_FALSE(JournalFile::keyIn(file()).has_value() && JournalFile::keyIn(file()) == "key=1");
    EXPECT_EQ(goodBlocks(opened()), 0u) << at;
  }
}

TEST_F(JournalOnDisk, BelongsToOneRunAtATime) {
  JournalFile journal = opened();
  journal.keep(kKind, 0, block(0));
  expectError<RunError>(file(), "in use by another run", [&] { opened(); });
  journal.remove();
  EXPECT_EQ(files(), 0u);
  // The name is free while the lock is still held.
  JournalFile next = opened();
  next.keep(kKind, 1, block(1));
  EXPECT_FALSE(next.has(kKind, 0));
  journal.keep(kKind, 2, block(2));
  EXPECT_EQ(files(), 1u);
}

TEST_F(JournalOnDisk, AForeignFileIsLeftUnchanged) {
  const std::vector<char> text(100, 'x');
  save(file(), text);
  expectError<RunError>(file(), "holds no rows", [&] { opened(); });
  EXPECT_EQ(load(file()), text);
  expectError<RunError>(path("none/out.rows"), "No such file",
                        [&] { JournalFile(path("none/out.rows"), "key=1", true); });
}

TEST_F(JournalOnDisk, AFullDiskEndsTheJournalNotTheRun) {
  {
    JournalFile journal = opened();
    const FullDisk full(3000);
    for (std::size_t k = 0; k < kBlocks; ++k) journal.keep(kKind, k, block(k));
    EXPECT_FALSE(journal.failure().empty());
  }
  const JournalFile journal = opened();
  EXPECT_EQ(journal.atOpening().damaged, 0u);
  EXPECT_GT(goodBlocks(journal), 3u);
  EXPECT_LT(goodBlocks(journal), kBlocks);
}

}  // namespace
}  // namespace radiosity
