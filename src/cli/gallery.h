// A folder of pages with an index of them.
#pragma once

#include <filesystem>
#include <string>

namespace radiosity::cli {

/// Whether the file is a page of this program.
bool isPage(const std::filesystem::path& path);

/// A scene's files in a gallery.
struct GalleryFiles {
  std::string page;
  std::string thumbnail;  ///< .png
};

/// Makes the folder if it is not there. Errors: InputError if it cannot be made, if `name` is that
/// of the index, or if a file that is no page has the page's name or the index'.
GalleryFiles galleryFiles(const std::string& folder, const std::string& name);

/// Writes index.html: all pages in the folder, by name, with their thumbnails. Returns their
/// number. Errors: as AtomicFile.
std::size_t writeGalleryIndex(const std::string& folder);

}  // namespace radiosity::cli
