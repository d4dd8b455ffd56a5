// What a results file may consist of. HDF5 reads other files and runs other code than its own where
// a file says so: values in another file, links to another file, filters that are loaded as needed.
#pragma once

#include <optional>
#include <string>

#include "results/h5.h"

namespace radiosity::h5 {

/// An object of a file that is not as we write it, and why.
struct ForeignObject {
  std::string path;  ///< "/scene/vertices"
  std::string what;  ///< "is a link to another file"
};

/// The first object of an open file, in no particular order, that we do not read: a link other than
/// a hard one, values in other files (external storage, virtual datasets), a filter other than our
/// checksums, groups without end. No value is read, and no other file is opened. Takes some
/// microseconds an object.
std::optional<ForeignObject> foreignObject(hid_t file);

}  // namespace radiosity::h5
