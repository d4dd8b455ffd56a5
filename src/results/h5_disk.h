// How HDF5 reaches the disk when we write.
#pragma once

#include "results/h5.h"

namespace radiosity::h5 {

/// A file driver for HDF5 that cannot fail. The first write the system refuses is remembered, what
/// comes after it is dropped, and HDF5 is told that all went well. HDF5 1.10 does not get over a
/// file it cannot flush: it stays half open, and the process crashes when the library shuts down.
/// The writer asks error() and throws the file away.
class Disk {
 public:
  Disk();
  Disk(const Disk&) = delete;  // HDF5 holds its address
  Disk& operator=(const Disk&) = delete;
  /// Makes files that are created with the property list `access` go through this object, which
  /// must outlive them.
  void serve(hid_t access);
  /// errno of the first refusal; 0: none so far.
  int error() const { return error_; }

 private:
  friend struct DiskFile;
  Handle driver_;
  int error_ = 0;
};

}  // namespace radiosity::h5
