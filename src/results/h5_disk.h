// Our file driver for HDF5, for writing.
#pragma once

#include <cstdint>
#include <vector>

#include "results/h5.h"

namespace radiosity::h5 {

/// A file driver for HDF5 that never fails. It remembers the first write that the system refuses,
/// drops all later ones, and reports success to HDF5. HDF5 1.10 cannot handle a file that it cannot
/// flush: the file stays half open, and the process crashes when the library shuts down. The writer
/// asks error() and discards the file.
///
/// An existing file is extended such that it is valid at every moment, even if the process is
/// killed: new data goes behind its end, where no reader looks; changes before the end stay in
/// memory. The file's first page has its end and the table of its groups. It is written last, in
/// one piece, and so switches from the old state to the new. If HDF5 changed more than that page,
/// the old state stays.
class Disk {
 public:
  enum class Mode { create, extend };
  explicit Disk(Mode mode = Mode::create);
  Disk(const Disk&) = delete;  // HDF5 holds its address
  Disk& operator=(const Disk&) = delete;
  /// Makes files that are created with the property list `access` use this object, which must
  /// outlive them.
  void serve(hid_t access);
  /// errno of the first refused write; 0: none so far.
  int error() const { return error_; }
  /// From now on closing an extended file switches to its new state. Without this call the old
  /// state stays.
  void allowSwitch() { may_switch_ = true; }
  /// Whether closing switched to the new state.
  bool switched() const { return switched_; }
  /// The old end of an extended file.
  std::uint64_t oldEnd() const { return old_end_; }
  /// While it lives, HDF5's writes of values are dropped, and their places are added to `places`.
  class Reserving {
   public:
    Reserving(Disk& disk, std::vector<std::uint64_t>& places) : disk_(disk) {
      disk_.reserved_ = &places;
    }
    ~Reserving() { disk_.reserved_ = nullptr; }
    Reserving(const Reserving&) = delete;
    Reserving& operator=(const Reserving&) = delete;

   private:
    Disk& disk_;
  };

 private:
  friend struct DiskFile;
  Mode mode_;
  Handle driver_;
  int error_ = 0;
  bool may_switch_ = false;
  bool switched_ = false;
  std::uint64_t old_end_ = 0;
  std::vector<std::uint64_t>* reserved_ = nullptr;
};

}  // namespace radiosity::h5
