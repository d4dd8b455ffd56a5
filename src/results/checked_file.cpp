#include "results/checked_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include "radiosity/base.h"

namespace radiosity {

CheckedFile::CheckedFile(const std::string& path)
    : path_(path), target_(path), file_(std::fopen(target_.temporary().c_str(), "wb")) {
  if (!file_) fail();
}

void CheckedFile::fail() const {
  throw RunError(fmt::format("{}: cannot be written: {}", path_, std::strerror(errno)));
}

void CheckedFile::write(const void* data, std::size_t size) {
  if (std::fwrite(data, 1, size, file_.get()) != size) fail();
}

void CheckedFile::commit() {
  if (std::fclose(file_.release()) != 0) fail();
  target_.commit();
}

}  // namespace radiosity
