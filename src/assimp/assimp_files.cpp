#include "assimp/assimp_files.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>
#include <stdexcept>
#include <utility>

namespace radiosity {

namespace {

struct OpenFile {
  std::string path;
  const std::string* content;
  std::size_t at = 0;
};

OpenFile& openFileOf(aiFile* file) { return *reinterpret_cast<OpenFile*>(file->UserData); }

std::size_t readSome(aiFile* file, char* out, std::size_t size, std::size_t count) {
  OpenFile& open = openFileOf(file);
  if (size == 0) return 0;
  const std::size_t whole = std::min(count, (open.content->size() - open.at) / size);
  std::memcpy(out, open.content->data() + open.at, whole * size);
  open.at += whole * size;
  return whole;
}

std::size_t writeNothing(aiFile*, const char*, std::size_t, std::size_t) { return 0; }

std::size_t tell(aiFile* file) { return openFileOf(file).at; }

std::size_t sizeOf(aiFile* file) { return openFileOf(file).content->size(); }

aiReturn seek(aiFile* file, std::size_t offset, aiOrigin origin) {
  OpenFile& open = openFileOf(file);
  const std::size_t size = open.content->size();
  const std::size_t from = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? open.at : size;
  if (offset > size - from) return aiReturn_FAILURE;
  open.at = from + offset;
  return aiReturn_SUCCESS;
}

void flushNothing(aiFile*) {}

}  // namespace

AssimpFiles::AssimpFiles(Read read) : read_(std::move(read)) {
  io_.OpenProc = &AssimpFiles::open;
  io_.CloseProc = &AssimpFiles::close;
  io_.UserData = reinterpret_cast<aiUserData>(this);
}

/// Opens a file for Assimp. Exceptions must not pass through Assimp's C functions.
aiFile* AssimpFiles::open(aiFileIO* io, const char* path, const char* /*mode*/) {
  AssimpFiles& self = *reinterpret_cast<AssimpFiles*>(io->UserData);
  try {
    constexpr int kMostAtOnce = 4;  // Assimp inspects a file before it reads it
    if (self.open_[path] >= kMostAtOnce) {
      throw std::runtime_error(std::string(path) +
                               ": is in itself (Inline); take the reference out");
    }
    auto found = self.content_.find(path);
    if (found == self.content_.end()) found = self.content_.emplace(path, self.read_(path)).first;
    auto open = std::make_unique<OpenFile>(OpenFile{path, &found->second});
    auto file =
        std::make_unique<aiFile>(aiFile{&readSome, &writeNothing, &tell, &sizeOf, &seek,
                                        &flushNothing, reinterpret_cast<aiUserData>(open.get())});
    ++self.open_[path];
    static_cast<void>(open.release());  // close() deletes both
    return file.release();
  } catch (const std::exception& error) {
    if (self.refusal_.empty()) self.refusal_ = error.what();
    return nullptr;
  }
}

void AssimpFiles::close(aiFileIO* io, aiFile* file) {
  AssimpFiles& self = *reinterpret_cast<AssimpFiles*>(io->UserData);
  const std::unique_ptr<aiFile> whole(file);
  const std::unique_ptr<OpenFile> open(&openFileOf(file));
  --self.open_[open->path];
}

}  // namespace radiosity
