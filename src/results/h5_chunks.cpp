#include "results/h5_chunks.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace radiosity::h5 {

std::vector<unsigned char> storedChunk(std::span<const unsigned char> data) {
  // Words of 16 bits, the first byte being the higher one; to the last of odd bytes belongs a 0.
  std::uint64_t sum = 0;
  std::uint64_t sum_of_sums = 0;  // below 2^64, since there are less than 2^24 words
  for (std::size_t k = 0; k < data.size(); k += 2) {
    sum += std::uint64_t(data[k]) << 8 | (k + 1 < data.size() ? data[k + 1] : 0U);
    sum_of_sums += sum;
  }
  // HDF5 adds the carries of 16 bits, which gives 65535, not 0, for multiples of it.
  const auto folded = [](std::uint64_t value) {
    return std::uint32_t(value == 0 ? 0 : (value - 1) % 65535 + 1);
  };
  const std::uint32_t checksum = folded(sum_of_sums) << 16 | folded(sum);
  std::vector<unsigned char> stored;
  stored.reserve(data.size() + sizeof checksum);
  stored.assign(data.begin(), data.end());
  for (int bit = 0; bit < 32; bit += 8) stored.push_back((unsigned char)(checksum >> bit));
  return stored;
}

ChunkFile::ChunkFile(const std::string& path, std::string shown)
    : path_(path),
      shown_(std::move(shown)),
      descriptor_(::open(path.c_str(), O_WRONLY | O_CLOEXEC)) {
  if (descriptor_ >= 0) return;
  throw RunError(fmt::format("{}: {} cannot be opened: {}; every process must see its folder",
                             shown_, path_, std::strerror(errno)));
}

ChunkFile::~ChunkFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void ChunkFile::write(const ReservedColumn& column, std::size_t chunk,
                      std::span<const unsigned char> data) const {
  const std::vector<unsigned char> stored = storedChunk(data);
  std::size_t done = 0;
  while (done < stored.size()) {
    const ssize_t count = pwrite(descriptor_, stored.data() + done, stored.size() - done,
                                 off_t(column.places[chunk] + done));
    if (count < 0 && errno != EINTR) fail(column.path);
    if (count > 0) done += std::size_t(count);
  }
}

void ChunkFile::close() {
  if (::close(std::exchange(descriptor_, -1)) != 0) fail("the file");
}

void ChunkFile::fail(const std::string& object) const {
  throw RunError(fmt::format("{}: {} cannot be written: {}", shown_, object, std::strerror(errno)));
}

}  // namespace radiosity::h5
