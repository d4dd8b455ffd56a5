// How HDF5 reaches the disk when we write.
#pragma once

#include <cstdint>

#include "results/h5.h"

namespace radiosity::h5 {

/// A file driver for HDF5 that cannot fail. The first write the system refuses is remembered, what
/// comes after it is dropped, and HDF5 is told that all went well. HDF5 1.10 does not get over a
/// file it cannot flush: it stays half open, and the process crashes when the library shuts down.
/// The writer asks error() and throws the file away.
///
/// An existing file is extended so that it is whole at every moment, also for one who kills the
/// process: what is new goes behind its end, where nobody looks; what HDF5 changes before that
/// stays in memory. The file's first page has its end and the table of its groups: written last, in
/// one piece, it switches from the old state to the new. Where HDF5 changed more than that page
/// nothing is switched.
class Disk {
 public:
  enum class Mode { create, extend };
  explicit Disk(Mode mode = Mode::create);
  Disk(const Disk&) = delete;  // HDF5 holds its address
  Disk& operator=(const Disk&) = delete;
  /// Makes files that are created with the property list `access` go through this object, which
  /// must outlive them.
  void serve(hid_t access);
  /// errno of the first refusal; 0: none so far.
  int error() const { return error_; }
  /// From now on closing an extended file switches to its new state; without it the old one stays.
  void allowSwitch() { may_switch_ = true; }
  /// Whether closing did.
  bool switched() const { return switched_; }
  /// Where an extended file ended.
  std::uint64_t oldEnd() const { return old_end_; }

 private:
  friend struct DiskFile;
  Mode mode_;
  Handle driver_;
  int error_ = 0;
  bool may_switch_ = false;
  bool switched_ = false;
  std::uint64_t old_end_ = 0;
};

}  // namespace radiosity::h5
