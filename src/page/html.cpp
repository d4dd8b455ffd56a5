#include "page/html.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "base/base64.h"
#include "results/checked_file.h"

namespace radiosity::page {

namespace {

constexpr std::size_t kChunk = std::size_t(1) << 20;

/// Owns zlib's compressor and ends it in any case.
class Deflate {
 public:
  Deflate() {
    constexpr int kGzip = 16;  // added to the window's bits: a gzip header and trailer
    constexpr int kMemoryLevel = 8;
    if (deflateInit2(&stream_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, MAX_WBITS + kGzip, kMemoryLevel,
                     Z_DEFAULT_STRATEGY) != Z_OK) {
      throw std::bad_alloc();
    }
  }
  ~Deflate() { deflateEnd(&stream_); }
  Deflate(const Deflate&) = delete;
  Deflate& operator=(const Deflate&) = delete;

  void append(std::span<const std::byte> chunk, bool is_last, std::string& out) {
    // zlib's interface has no const here.
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(chunk.data()));
    stream_.avail_in = uInt(chunk.size());
    do {
      stream_.next_out = buffer_.data();
      stream_.avail_out = uInt(buffer_.size());
      deflate(&stream_, is_last ? Z_FINISH : Z_NO_FLUSH);
      out.append(reinterpret_cast<const char*>(buffer_.data()), buffer_.size() - stream_.avail_out);
    } while (stream_.avail_out == 0);
  }

 private:
  z_stream stream_{};
  std::array<Bytef, (std::size_t(1) << 16)> buffer_{};
};

}  // namespace

std::string gzipped(std::span<const std::byte> data, Progress& progress) {
  Deflate deflate;
  std::string out;
  progress.begin("packing", data.size() / kChunk + 1);
  for (std::size_t begin = 0; begin == 0 || begin < data.size(); begin += kChunk) {
    progress.check();
    const std::size_t size = std::min(kChunk, data.size() - begin);
    deflate.append(data.subspan(begin, size), begin + size == data.size(), out);
    progress.advance();
  }
  progress.end();
  return out;
}

std::size_t writeHtml(const std::string& path, std::string_view page_template,
                      std::span<const std::byte> data, Progress& progress) {
  const std::size_t at = page_template.find(kDataMark);
  if (at == std::string_view::npos) {
    throw RunError(path + ": the template has no place for data; build the program again");
  }
  const std::string text = base64(gzipped(data, progress));
  CheckedFile file(path);
  file.write(page_template.substr(0, at));
  file.write(R"(<script id="radiosity-data" type="application/octet-stream">)");
  file.write(text);
  file.write("</script>");
  file.write(page_template.substr(at + kDataMark.size()));
  file.commit();
  return text.size();
}

}  // namespace radiosity::page
