// From data to HTML: a browser unpacks the data that went in.
#include <gtest/gtest.h>
#include <zlib.h>

#include <string>
#include <vector>

#include "base/base64.h"
#include "page/html.h"
#include "support/results_folder.h"

namespace radiosity {
namespace {

using page::gzipped;
using page::writeHtml;

std::vector<std::byte> noise(std::size_t size) {
  std::vector<std::byte> data(size);
  std::uint32_t state = 1;
  for (std::byte& b : data) {
    state = state * 1664525 + 1013904223;  // Numerical Recipes
    b = std::byte(state >> 24U);
  }
  return data;
}

/// As another program unpacks gzip.
std::vector<std::byte> unpacked(const std::string& packed, std::size_t size) {
  std::vector<std::byte> data(size + 1);
  z_stream stream{};
  EXPECT_EQ(inflateInit2(&stream, 16 + MAX_WBITS), Z_OK);
  std::string input = packed;
  stream.next_in = reinterpret_cast<Bytef*>(input.data());
  stream.avail_in = uInt(input.size());
  stream.next_out = reinterpret_cast<Bytef*>(data.data());
  stream.avail_out = uInt(data.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  data.resize(stream.total_out);
  inflateEnd(&stream);
  return data;
}

TEST(PageHtml, Base64FollowsTheStandard) {
  // RFC 4648, section 10.
  const std::pair<const char*, const char*> vectors[] = {{"", ""},
                                                         {"f", "Zg=="},
                                                         {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},
                                                         {"foob", "Zm9vYg=="},
                                                         {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"}};
  for (const auto& [text, coded] : vectors) EXPECT_EQ(base64(text), coded);
  EXPECT_EQ(base64(std::string("\xff\xfb\xbf\x00", 4)), "//u/AA==");
}

TEST(PageHtml, DataOfAnySizeAreUnpackedUnchanged) {
  Progress progress;
  // About the megabyte that is packed at a time.
  for (const std::size_t size : {0u, 1u, 1048575u, 1048576u, 1048577u, 3000000u}) {
    const std::vector<std::byte> data = noise(size);
    EXPECT_EQ(unpacked(gzipped(data, progress), size), data) << size;
  }
}

class PageHtmlFile : public FolderTest {};

TEST_F(PageHtmlFile, DataReplaceTheMark) {
  const std::vector<std::byte> data = noise(5);
  const std::size_t size =
      writeHtml(path("p.html"), "<p>before</p><!--radiosity-data--><p>after</p>", data, progress_);
  const std::string coded = base64(gzipped(data, progress_));
  EXPECT_EQ(size, coded.size());
  const std::vector<char> page = load(path("p.html"));
  EXPECT_EQ(std::string(page.begin(), page.end()),
            "<p>before</p><script id=\"radiosity-data\" type=\"application/octet-stream\">" +
                coded + "</script><p>after</p>");
}

TEST_F(PageHtmlFile, AFailedWriteLeavesNoFile) {
  const std::vector<std::byte> data = noise(100000);
  const std::string file = path("p.html");
  expectError<RunError>(file, "no place for data",
                        [&] { writeHtml(file, "<html></html>", data, progress_); });
  {
    const FullDisk full(20000);
    expectError<RunError>(file, "",
                          [&] { writeHtml(file, "<!--radiosity-data-->", data, progress_); });
  }
  progress_.cancel();
  EXPECT_THROW(writeHtml(file, "<!--radiosity-data-->", data, progress_), Cancelled);
  EXPECT_EQ(files(), 0u);
}

}  // namespace
}  // namespace radiosity
