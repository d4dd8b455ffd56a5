// Scratch memory aligned for whole-vector loads.
#pragma once

#include <cstddef>
#include <memory>
#include <new>

namespace radiosity {

/// An uninitialised array of trivial values, aligned to a cache line. Grows, never shrinks;
/// growing loses the contents.
template <class T>
class AlignedBuffer {
 public:
  static constexpr std::size_t kAlignment = 64;

  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  std::size_t size() const { return size_; }
  void reserve(std::size_t size) {
    if (size <= size_) return;
    data_.reset(static_cast<T*>(::operator new(size * sizeof(T), std::align_val_t{kAlignment})));
    size_ = size;
  }

 private:
  struct Free {
    void operator()(T* p) const { ::operator delete(p, std::align_val_t{kAlignment}); }
  };
  std::unique_ptr<T, Free> data_;
  std::size_t size_ = 0;
};

}  // namespace radiosity
