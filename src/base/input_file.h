// Opens files that a person named: regular files only, since a pipe or a device may never end.
#pragma once

#include <string>

namespace radiosity {

/// The reason why `path` cannot be opened as a file, with the cure ("no such file; check the name
/// and the folder"). Empty for a readable regular file, also one behind a link.
std::string whyNotAFile(const std::string& path);

/// Throws InputError "PATH: why; cure" unless `path` is a regular file.
void requireFile(const std::string& path);

/// Whether this process found the file by one of these functions, under any name: it is an input,
/// which no output should replace.
bool wasFound(const std::string& path);

/// The whole file as bytes. Errors: InputError if it is not a regular file, unreadable or empty;
/// RunError if it does not fit into memory.
std::string readWholeFile(const std::string& path);

/// The identity and state of the file that a name stands for now: it changes when the file is
/// replaced or written to. Empty if there is no file.
std::string fileState(const std::string& path);

}  // namespace radiosity
