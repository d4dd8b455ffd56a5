// Columns of an HDF5 file: HDF5 itself reads the values back, and tests the checksums that we
// computed.
#include "results/column_writer.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "results/h5_reader.h"
#include "support/results_folder.h"

namespace radiosity::h5 {
namespace {

class ColumnWriterTest : public FolderTest {
 protected:
  std::string file() const { return path("x.h5"); }

  /// Writes values in pieces of different lengths.
  template <class T>
  void write(const std::vector<T>& values) {
    OutputFile target(file(), file());
    OutputGroup root(target);
    ColumnWriter<T> writer(root, "values", values.size());
    std::size_t piece = 1;
    for (std::size_t at = 0; at < values.size(); at += piece, piece = piece * 7 % 300007) {
      piece = std::min(piece, values.size() - at);
      std::copy_n(values.begin() + std::ptrdiff_t(at), piece, writer.extend(piece).begin());
    }
    writer.flush();
  }

  template <class T>
  std::vector<T> read() const {
    const InputFile source(file());
    const InputGroup root(source);
    std::size_t rows = 0;
    const Handle dataset = root.open("values", numberOf<T>(), 0, rows);
    std::vector<T> values(rows);
    if (rows > 0) root.readAll("values", dataset, numberOf<T>(), values.data());
    return values;
  }

  template <class T>
  void expectBack(const std::vector<T>& values) {
    write(values);
    EXPECT_EQ(read<T>(), values);
  }
};

TEST_F(ColumnWriterTest, HDF5ReadsBytesOfAnyLength) {
  std::mt19937 random(2);
  // Chunks of an even and of an odd number of bytes.
  for (const std::size_t count : {kCompactBytes + 1, kCompactBytes + 2, 2 * kChunkBytes + 1}) {
    std::vector<std::uint8_t> values(count);
    for (std::uint8_t& value : values) value = std::uint8_t(random());
    expectBack(values);
  }
}

TEST_F(ColumnWriterTest, HDF5ReadsColumnsOfAnyLength) {
  std::mt19937 random(1);
  const std::size_t chunk = kChunkBytes / sizeof(std::int32_t);
  for (const std::size_t count : {std::size_t(0), std::size_t(1), kCompactBytes / 4,
                                  kCompactBytes / 4 + 1, chunk, chunk + 1, 11 * chunk + 12345}) {
    std::vector<std::int32_t> values(count);
    for (std::int32_t& value : values) value = std::int32_t(random());
    expectBack(values);
  }
}

TEST_F(ColumnWriterTest, PartsWrittenInAnyOrderMakeTheWholeColumn) {
  std::vector<double> values(2'000'003);
  std::iota(values.begin(), values.end(), 0.5);
  OutputFile target(file(), file());
  {
    OutputGroup root(target);
    const ReservedColumn column = root.reserve("values", Number::f64, values.size());
    const std::size_t chunks = column.places.size();
    ASSERT_GE(chunks, 12u);
    // Each part begins with some values before its chunks, and ends with some behind them.
    for (const ChunkRange part : {ChunkRange{7, chunks}, ChunkRange{0, 1}, ChunkRange{1, 7}}) {
      const std::size_t from = part.first * column.chunk - std::min<std::size_t>(part.first, 1000);
      const std::size_t end = std::min(part.last * column.chunk + 777, values.size());
      ColumnWriter<double> writer(column, root.chunks(), part, from);
      for (std::size_t at = from; at < end;) {
        const std::size_t piece = std::min<std::size_t>(100'000, end - at);
        std::copy_n(values.begin() + std::ptrdiff_t(at), piece, writer.extend(piece).begin());
        at += piece;
      }
      writer.flush();
    }
  }
  target.close();
  EXPECT_EQ(read<double>(), values);
}

// The checksum's sums modulo 65535 are 0 in both; only the first is stored as 0.
TEST_F(ColumnWriterTest, HDF5TakesTheChecksumsOfZerosAndOfOnes) {
  expectBack(std::vector<std::int32_t>(100000, 0));
  expectBack(std::vector<std::int32_t>(100000, -1));
}

TEST_F(ColumnWriterTest, HDF5TakesTheLargestSumsThatAChunkCanHave) {
  std::vector<double> values(3 * kChunkBytes / sizeof(double));
  std::iota(values.begin(), values.end(), -1e300);
  expectBack(values);
  const double large = std::numeric_limits<double>::max();  // bytes of 255, but for two
  expectBack(std::vector<double>(3 * kChunkBytes / sizeof(double), -large));
}

// Words 6162 and 6364, hexadecimal.
TEST(StoredChunk, EndsWithTheChecksumOfItsWords) {
  const std::vector<unsigned char> bytes = {'a', 'b', 'c', 'd'};
  const std::vector<unsigned char> stored = storedChunk(bytes);
  const std::uint32_t first = 0x6162 + 0x6364;
  const std::uint32_t second = (2 * 0x6162 + 0x6364) % 65535;
  ASSERT_EQ(stored.size(), 8u);
  EXPECT_EQ(stored[4] | stored[5] << 8, int(first));
  EXPECT_EQ(stored[6] | stored[7] << 8, int(second));
}

}  // namespace
}  // namespace radiosity::h5
