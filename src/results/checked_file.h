// A file that is written from start to end, whole or not at all, with every write checked.
#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include "base/atomic_file.h"

namespace radiosity {

/// Errors: as AtomicFile, and RunError with the system's reason if a write fails.
class CheckedFile {
 public:
  explicit CheckedFile(const std::string& path);
  void write(const void* data, std::size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// Closes the file and gives it its name; without this call the file is removed.
  void commit();

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  [[noreturn]] void fail() const;

  std::string path_;
  AtomicFile target_;  // before file_, so that it is removed after file_ is closed
  std::unique_ptr<std::FILE, Closer> file_;
};

}  // namespace radiosity
