// A file written from start to end, whole or not at all, every write checked.
#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include "base/atomic_file.h"

namespace radiosity {

/// Errors: as AtomicFile, and RunError with the system's reason where a write fails.
class CheckedFile {
 public:
  explicit CheckedFile(const std::string& path);
  void write(const void* data, std::size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// Closes and gives the file its name; without it nothing stays.
  void commit();

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  [[noreturn]] void fail() const;

  std::string path_;
  AtomicFile target_;  // before file_: closed first, then removed
  std::unique_ptr<std::FILE, Closer> file_;
};

}  // namespace radiosity
