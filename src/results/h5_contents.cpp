#include "results/h5_contents.h"

#include <fmt/format.h>

#include <vector>

namespace radiosity::h5 {

namespace {

/// Ours have a few hundred, and one a texture.
constexpr std::size_t kMostObjects = 100'000;
/// Ours are 4 deep. Hard links may lead back to a group that they are in.
constexpr std::size_t kMostDepth = 16;

struct Link {
  std::string name;
  H5L_type_t type;
};

herr_t keepLink(hid_t /*group*/, const char* name, const H5L_info_t* info, void* data) {
  auto& links = *static_cast<std::vector<Link>*>(data);
  links.push_back({name, info->type});
  return links.size() > kMostObjects ? 1 : 0;
}

/// Why the link is not followed; empty for a hard link.
std::string faultOf(const Link& link) {
  if (link.type == H5L_TYPE_HARD) return {};
  return link.type == H5L_TYPE_EXTERNAL ? "is a link to another file"
                                        : "is a link by name, not an object of its own";
}

/// Why an object that was created so is not read; empty: it is.
std::string faultOfFilters(hid_t creation) {
  const int count = H5Pget_nfilters(creation);
  if (count < 0) return "has filters that cannot be told";
  for (unsigned k = 0; k < unsigned(count); ++k) {
    unsigned flags = 0;
    std::size_t values = 0;
    const H5Z_filter_t filter =
        H5Pget_filter2(creation, k, &flags, &values, nullptr, 0, nullptr, nullptr);
    if (filter == H5Z_FILTER_FLETCHER32) continue;
    return fmt::format(
        "passes through the filter {}, and only checksums are read (h5repack -f NONE "
        "removes filters)",
        int(filter));
  }
  return {};
}

std::string faultOfDataset(hid_t dataset) {
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose);
  if (!creation) return "is damaged";
  if (H5Pget_external_count(creation.get()) != 0) return "has its values in another file";
  if (H5Pget_layout(creation.get()) == H5D_VIRTUAL) return "is put together from other files";
  return faultOfFilters(creation.get());
}

class Walk {
 public:
  /// Visits the group and what is below it.
  std::optional<ForeignObject> group(hid_t id, const std::string& path, std::size_t depth) {
    const ForeignObject endless{path, "has groups without end"};
    if (depth > kMostDepth) return endless;
    const Handle creation(H5Gget_create_plist(id), H5Pclose);
    const std::string fault = creation ? faultOfFilters(creation.get()) : "is damaged";
    if (!fault.empty()) return ForeignObject{path, fault};
    std::vector<Link> links;
    if (H5Literate(id, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, keepLink, &links) < 0) {
      return ForeignObject{path, fmt::format("is damaged ({})", lastError())};
    }
    objects_ += links.size();
    if (objects_ > kMostObjects) return endless;
    for (const Link& link : links) {
      const std::string below = (path == "/" ? path : path + "/") + link.name;
      if (auto found = object(id, link, below, depth)) return found;
    }
    return std::nullopt;
  }

 private:
  std::optional<ForeignObject> object(hid_t parent, const Link& link, const std::string& path,
                                      std::size_t depth) {
    if (const std::string fault = faultOf(link); !fault.empty()) return ForeignObject{path, fault};
    const Handle id(H5Oopen(parent, link.name.c_str(), H5P_DEFAULT), H5Oclose);
    if (!id) return ForeignObject{path, fmt::format("is damaged ({})", lastError())};
    const H5I_type_t type = H5Iget_type(id.get());
    if (type == H5I_GROUP) return group(id.get(), path, depth + 1);
    if (type != H5I_DATASET) return ForeignObject{path, "is neither a group nor a dataset"};
    if (const std::string fault = faultOfDataset(id.get()); !fault.empty()) {
      return ForeignObject{path, fault};
    }
    return std::nullopt;
  }

  std::size_t objects_ = 0;
};

}  // namespace

std::optional<ForeignObject> foreignObject(hid_t file) {
  const Handle root(H5Gopen2(file, "/", H5P_DEFAULT), H5Gclose);
  if (!root) return ForeignObject{"/", "is damaged"};
  return Walk().group(root.get(), "/", 0);
}

}  // namespace radiosity::h5
