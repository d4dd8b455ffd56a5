#include "cli/gallery.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <string_view>
#include <vector>

#include "base/atomic_file.h"
#include "base/printable.h"
#include "radiosity/base.h"

namespace radiosity::cli {

namespace fs = std::filesystem;

namespace {

constexpr const char* kIndex = "index.html";
constexpr const char* kIndexMark = "name=\"generator\" content=\"radiosity gallery\"";

bool holds(const fs::path& path, const char* text) {
  std::ifstream file(path, std::ios::binary);
  const std::string all{std::istreambuf_iterator<char>(file), {}};
  return all.find(text) != std::string::npos;
}

/// A file name as a part of an address (RFC 3986).
std::string address(const std::string& name) {
  std::string out;
  for (const char c : name) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                       std::string_view("-._~").find(c) != std::string_view::npos;
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

std::vector<fs::path> pagesIn(const fs::path& folder) {
  std::vector<fs::path> pages;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const fs::path& path = entry.path();
    if (path.extension() == ".html" && path.filename() != kIndex && isPage(path)) {
      pages.push_back(path);
    }
  }
  std::ranges::sort(pages);
  return pages;
}

constexpr const char* kHead = R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta {}>
<title>radiosity</title>
<style>
body {{ font: 16px/1.4 system-ui, sans-serif; margin: 0 auto; max-width: 1200px; padding: 24px; }}
main {{ display: grid; grid-template-columns: repeat(auto-fill, minmax(280px, 1fr)); gap: 24px; }}
a {{ color: inherit; text-decoration: none; }} a:hover span {{ text-decoration: underline; }}
img {{ display: block; width: 100%; aspect-ratio: 4 / 3; object-fit: contain; background: #8884; border-radius: 6px; }}
span {{ display: block; padding: 6px 2px; overflow-wrap: anywhere; }}
</style>
</head>
<body>
<h1>Scenes</h1>
<main>
)";

}  // namespace

bool isPage(const fs::path& path) { return holds(path, "id=\"radiosity-data\""); }

GalleryFiles galleryFiles(const std::string& folder, const std::string& name) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) {
    throw InputError(
        fmt::format("--gallery {}: the folder cannot be made: {}", folder, failed.message()));
  }
  const fs::path page = fs::path(folder) / (name + ".html");
  const fs::path index = fs::path(folder) / kIndex;
  if (page == index) {
    throw InputError(
        fmt::format("--gallery {}: a scene named 'index' would have the name of the "
                    "gallery's own page; rename the scene's file",
                    folder));
  }
  if (fs::exists(page) && !isPage(page)) {
    throw InputError(page.string() + ": is there and is no page of this program; move it away");
  }
  if (fs::exists(index) && !holds(index, kIndexMark)) {
    throw InputError(index.string() +
                     ": is there and is no gallery of this program; name another "
                     "folder with --gallery");
  }
  return {page.string(), (fs::path(folder) / (name + ".png")).string()};
}

std::size_t writeGalleryIndex(const std::string& folder) {
  const std::vector<fs::path> pages = pagesIn(folder);
  std::string text = fmt::format(kHead, kIndexMark);
  for (const fs::path& page : pages) {
    const std::string name = page.stem().string();
    text += fmt::format("<a href=\"{}\">", address(page.filename().string()));
    if (fs::exists(fs::path(folder) / (name + ".png"))) {
      text += fmt::format("<img src=\"{}\" alt=\"\">", address(name + ".png"));
    }
    text += fmt::format("<span>{}</span></a>\n", markupText(name));
  }
  text += "</main>\n</body>\n</html>\n";
  writeWholeFile((fs::path(folder) / kIndex).string(), text);
  return pages.size();
}

}  // namespace radiosity::cli
