// OpenGL's objects, deleted with their owners. All belong to the current context.
#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <initializer_list>
#include <span>
#include <utility>
#include <vector>

namespace radiosity::gl {

/// The groups of `size` invocations that make `count` in total.
inline GLuint groups(std::size_t count, std::size_t size) {
  return GLuint((count + size - 1) / size);
}

/// Memory of the device.
class Buffer {
 public:
  Buffer() { glGenBuffers(1, &name_); }
  ~Buffer() { glDeleteBuffers(1, &name_); }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;

  GLuint name() const { return name_; }
  std::size_t bytes() const { return bytes_; }

  /// The contents become undefined. Reserves at least four bytes: an empty buffer cannot be bound.
  void reserve(std::size_t bytes, GLenum usage = GL_DYNAMIC_COPY) {
    bytes_ = bytes < 4 ? 4 : bytes;
    glBindBuffer(GL_COPY_WRITE_BUFFER, name_);
    glBufferData(GL_COPY_WRITE_BUFFER, GLsizeiptr(bytes_), nullptr, usage);
  }
  template <class Value>
  void write(std::span<const Value> values) {
    if (values.empty()) return;
    glBindBuffer(GL_COPY_WRITE_BUFFER, name_);
    glBufferSubData(GL_COPY_WRITE_BUFFER, 0, GLsizeiptr(values.size_bytes()), values.data());
  }
  template <class Value>
  void store(std::span<const Value> values) {
    reserve(values.size_bytes(), GL_STATIC_DRAW);
    write(values);
  }
  void clear() {
    glBindBuffer(GL_COPY_WRITE_BUFFER, name_);
    glClearBufferData(GL_COPY_WRITE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
  }

 private:
  GLuint name_ = 0;
  std::size_t bytes_ = 0;
};

/// Memory that the device writes and this program reads, mapped as long as it lives.
class MappedBuffer {
 public:
  explicit MappedBuffer(std::size_t bytes) {
    constexpr GLbitfield kAccess = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    glGenBuffers(1, &name_);
    glBindBuffer(GL_COPY_WRITE_BUFFER, name_);
    glBufferStorage(GL_COPY_WRITE_BUFFER, GLsizeiptr(bytes), nullptr,
                    kAccess | GL_CLIENT_STORAGE_BIT);
    data_ = glMapBufferRange(GL_COPY_WRITE_BUFFER, 0, GLsizeiptr(bytes), kAccess);
  }
  ~MappedBuffer() { glDeleteBuffers(1, &name_); }
  MappedBuffer(const MappedBuffer&) = delete;
  MappedBuffer& operator=(const MappedBuffer&) = delete;

  /// Null if the memory could not be mapped.
  const std::byte* data() const { return static_cast<const std::byte*>(data_); }
  /// Copies the first `bytes` of `from` to place `at`.
  void copy(const Buffer& from, std::size_t at, std::size_t bytes) {
    glBindBuffer(GL_COPY_READ_BUFFER, from.name());
    glBindBuffer(GL_COPY_WRITE_BUFFER, name_);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, GLintptr(at),
                        GLsizeiptr(bytes));
  }

 private:
  GLuint name_ = 0;
  void* data_ = nullptr;
};

/// Passed once all earlier commands are done.
class Fence {
 public:
  Fence() = default;
  ~Fence() { glDeleteSync(sync_); }
  Fence(const Fence&) = delete;
  Fence& operator=(const Fence&) = delete;
  void set() {
    glDeleteSync(std::exchange(sync_, glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)));
    glFlush();
  }
  /// Waits up to a tenth of a second; false if the fence is not passed by then.
  bool wait() const {
    constexpr GLuint64 kNanoseconds = 100'000'000;
    const GLenum state = glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, kNanoseconds);
    return state == GL_ALREADY_SIGNALED || state == GL_CONDITION_SATISFIED;
  }

 private:
  GLsync sync_ = nullptr;
};

/// Linked shaders.
class Program {
 public:
  struct Stage {
    GLenum kind;
    std::vector<const char*> source;  ///< one after the other
  };
  /// Throws Failure with the driver's words if a stage does not compile.
  explicit Program(std::initializer_list<Stage> stages);
  ~Program() { glDeleteProgram(name_); }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void use() const { glUseProgram(name_); }
  GLint uniform(const char* name) const { return glGetUniformLocation(name_, name); }
  /// Uses the program, with these buffers as its storage blocks 0, 1, ...
  void useWith(std::initializer_list<const Buffer*> blocks) const;

 private:
  GLuint name_;
};

}  // namespace radiosity::gl
