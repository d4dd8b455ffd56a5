// Opening what a person named: regular files only, since a pipe or a device may never end.
#pragma once

#include <string>

namespace radiosity {

/// Why `path` cannot be opened as a file, with the cure ("no such file; check the name and the
/// folder"); empty for a regular file that may be read, also one behind a link.
std::string whyNotAFile(const std::string& path);

/// Throws InputError "PATH: why; cure" unless `path` is a regular file.
void requireFile(const std::string& path);

/// The whole file as bytes. Errors: InputError for what is no regular file, unreadable or empty;
/// RunError where it does not fit into memory.
std::string readWholeFile(const std::string& path);

/// Which file a name stands for at this moment, and in which state: differs once the file is
/// replaced or written to. Empty where there is none.
std::string fileState(const std::string& path);

}  // namespace radiosity
