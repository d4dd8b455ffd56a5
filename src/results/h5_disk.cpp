#include "results/h5_disk.h"

#include <H5FDpublic.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace radiosity::h5 {

/// HDF5 sees the first member only; it must be the first.
struct DiskFile {
  H5FD_t base{};
  Disk* disk = nullptr;
  int descriptor = -1;
  haddr_t allocated = 0;  ///< "end of allocation": how long HDF5 wants the file
  haddr_t end = 0;        ///< how long it is

  static DiskFile* of(H5FD_t* file) { return reinterpret_cast<DiskFile*>(file); }
  static const DiskFile* of(const H5FD_t* file) { return reinterpret_cast<const DiskFile*>(file); }

  static void refuse(Disk& disk) {
    if (disk.error_ == 0) disk.error_ = errno;
  }

  static H5FD_t* open(const char* name, unsigned /*flags*/, hid_t access, haddr_t /*most*/) {
    Disk* disk = *static_cast<Disk* const*>(H5Pget_driver_info(access));
    const int descriptor = ::open(name, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor < 0) {
      refuse(*disk);
      return nullptr;
    }
    auto* file = new DiskFile;
    file->disk = disk;
    file->descriptor = descriptor;
    return &file->base;
  }

  static herr_t close(H5FD_t* base) {
    DiskFile* file = of(base);
    if (::close(file->descriptor) != 0) refuse(*file->disk);
    delete file;
    return 0;
  }

  static herr_t read(H5FD_t* base, H5FD_mem_t /*type*/, hid_t /*transfer*/, haddr_t address,
                     std::size_t size, void* buffer) {
    auto* bytes = static_cast<char*>(buffer);
    while (size > 0) {
      const ssize_t count = pread(of(base)->descriptor, bytes, size, off_t(address));
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) break;
      bytes += count;
      address += haddr_t(count);
      size -= std::size_t(count);
    }
    std::memset(bytes, 0, size);  // HDF5 takes what was never written for zeros
    return 0;
  }

  static herr_t write(H5FD_t* base, H5FD_mem_t /*type*/, hid_t /*transfer*/, haddr_t address,
                      std::size_t size, const void* buffer) {
    DiskFile* file = of(base);
    const auto* bytes = static_cast<const char*>(buffer);
    file->end = std::max(file->end, address + size);
    while (size > 0 && file->disk->error_ == 0) {
      const ssize_t count = pwrite(file->descriptor, bytes, size, off_t(address));
      if (count < 0) {
        if (errno != EINTR) refuse(*file->disk);
        continue;
      }
      bytes += count;
      address += haddr_t(count);
      size -= std::size_t(count);
    }
    return 0;
  }

  static herr_t truncate(H5FD_t* base, hid_t /*transfer*/, hbool_t /*closing*/) {
    DiskFile* file = of(base);
    if (file->allocated == file->end || file->disk->error_ != 0) return 0;
    if (ftruncate(file->descriptor, off_t(file->allocated)) != 0) refuse(*file->disk);
    file->end = file->allocated;
    return 0;
  }

  static herr_t query(const H5FD_t* /*base*/, unsigned long* flags) {
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
             H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
    return 0;
  }
  static haddr_t allocation(const H5FD_t* base, H5FD_mem_t /*type*/) { return of(base)->allocated; }
  static herr_t setAllocation(H5FD_t* base, H5FD_mem_t /*type*/, haddr_t address) {
    of(base)->allocated = address;
    return 0;
  }
  static haddr_t fileEnd(const H5FD_t* base, H5FD_mem_t /*type*/) { return of(base)->end; }

  static H5FD_class_t driver() {
    H5FD_class_t d{};
    d.name = "radiosity";
    d.maxaddr = (haddr_t(1) << 62);
    d.fc_degree = H5F_CLOSE_STRONG;
    d.fapl_size = sizeof(Disk*);
    d.open = open;
    d.close = close;
    d.query = query;
    d.get_eoa = allocation;
    d.set_eoa = setAllocation;
    d.get_eof = fileEnd;
    d.read = read;
    d.write = write;
    d.truncate = truncate;
    const H5FD_mem_t kinds[H5FD_MEM_NTYPES] = H5FD_FLMAP_DICHOTOMY;
    std::copy(std::begin(kinds), std::end(kinds), d.fl_map);
    return d;
  }
};

Disk::Disk() {
  static const H5FD_class_t kDriver = DiskFile::driver();
  driver_ = Handle(H5FDregister(&kDriver), H5FDunregister);
}

void Disk::serve(hid_t access) {
  Disk* self = this;
  H5Pset_driver(access, driver_.get(), &self);
}

}  // namespace radiosity::h5
