// Rows that go to other processes so that all have about as much work.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "matrix/row_owners.h"

namespace radiosity {
namespace {

std::vector<double> loadsOf(const RowOwners& owners, int processes) {
  std::vector<double> load(std::size_t(processes), 0.0);
  for (std::size_t k = 0; k < owners.work.size(); ++k) {
    if (owners.owner[k] >= 0) load[std::size_t(owners.owner[k])] += double(owners.work[k]);
  }
  return load;
}

/// The owners after the moves; no row moves twice, and none of another process than its own.
RowOwners moved(const RowOwners& owners, const std::vector<RowMove>& moves) {
  RowOwners after = owners;
  for (const RowMove& move : moves) {
    EXPECT_LT(move.first, move.last);
    EXPECT_NE(move.from, move.to);
    for (std::size_t k = move.first; k < move.last; ++k) {
      if (owners.owner[k] != move.from) continue;
      EXPECT_EQ(after.owner[k], move.from) << "row " << k;
      after.owner[k] = move.to;
    }
  }
  return after;
}

/// A full triangle of `rows` rows in blocks of 64, of which each process has what `owner` says.
template <class Owner>
RowOwners triangle(std::size_t rows, const Owner& owner) {
  RowOwners owners;
  for (std::size_t k = 0; k < rows; ++k) {
    owners.work.push_back(rows - 1 - k);
    owners.owner.push_back(owners.work.back() > 0 ? owner(k / 64) : RowOwners::kNobody);
  }
  return owners;
}

/// A process may keep what the others cannot take: each of them lacks less than the longest row.
void expectEven(const RowOwners& owners, int processes) {
  const std::vector<double> load = loadsOf(owners, processes);
  double share = 0;
  for (const double of_one : load) share += of_one / processes;
  const auto row = double(*std::max_element(owners.work.begin(), owners.work.end()));
  EXPECT_LE(*std::max_element(load.begin(), load.end()), share + processes * row);
}

TEST(MatrixRowOwners, SharesBecomeEvenToARowOfEachProcess) {
  for (const int processes : {2, 4, 7}) {
    // The first process has every third block beside its own.
    const RowOwners owners = triangle(4000, [&](std::size_t block) {
      return block % 3 == 0 ? 0 : int(block % std::size_t(processes));
    });
    const std::vector<RowMove> moves = evenMoves(owners, processes);
    EXPECT_FALSE(moves.empty());
    expectEven(moved(owners, moves), processes);
  }
}

TEST(MatrixRowOwners, RowsLeaveInFewStretches) {
  const RowOwners owners = triangle(4000, [](std::size_t block) { return block < 40 ? 0 : 1; });
  EXPECT_EQ(evenMoves(owners, 2).size(), 1U);
}

TEST(MatrixRowOwners, RowsTooLargeToMoveStayAndSmallerOnesGo) {
  RowOwners owners;
  owners.work = {90, 5, 80, 5, 5, 40};
  owners.owner = {0, 0, 0, 0, 0, 1};
  // 185 and 40; the share is 112.5: the first row is too large, the third too.
  const RowOwners after = moved(owners, evenMoves(owners, 2));
  EXPECT_EQ(after.owner, (std::vector<int>{0, 1, 0, 1, 1, 1}));
}

TEST(MatrixRowOwners, EvenSharesStay) {
  // 0 1 1 0 0 1 1 0 ...: the longer rows of one pair of blocks make up for those of the next.
  const RowOwners owners =
      triangle(4000, [](std::size_t block) { return int((block + 1) / 2 % 2); });
  EXPECT_TRUE(evenMoves(owners, 2).empty());
  EXPECT_TRUE(evenMoves(triangle(4000, [](std::size_t) { return 0; }), 1).empty());
  EXPECT_TRUE(evenMoves({}, 3).empty());
}

}  // namespace
}  // namespace radiosity
