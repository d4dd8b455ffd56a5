#include "results/h5_disk.h"

#include <H5FDpublic.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <map>
#include <optional>

namespace radiosity::h5 {

namespace {

/// The number of bytes that the system writes to the disk in one piece.
constexpr std::size_t kPage = 4096;
using Page = std::array<char, kPage>;

bool readAll(int descriptor, haddr_t address, char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t count = pread(descriptor, bytes, size, off_t(address));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    bytes += count;
    address += haddr_t(count);
    size -= std::size_t(count);
  }
  std::memset(bytes, 0, size);  // HDF5 expects zeros where nothing was written
  return size == 0;
}

/// The end of the file according to its superblock ("HDF5 File Format Specification", II.A,
/// versions 2 and 3 with addresses of 8 bytes); empty for other files.
std::optional<haddr_t> endInSuperblock(int descriptor) {
  std::array<char, 48> block{};
  if (!readAll(descriptor, 0, block.data(), block.size())) return std::nullopt;
  const bool known = (block[8] == 2 || block[8] == 3) && block[9] == sizeof(haddr_t);
  haddr_t end = 0;
  std::memcpy(&end, block.data() + 28, sizeof end);
  return known && end > kPage ? std::optional(end) : std::nullopt;
}

}  // namespace

/// HDF5 only knows the first member, which must stay the first.
struct DiskFile {
  H5FD_t base{};
  Disk* disk = nullptr;
  int descriptor = -1;
  haddr_t allocated = 0;          ///< "end of allocation": the length that HDF5 wants
  haddr_t end = 0;                ///< the present length
  std::map<haddr_t, Page> pages;  ///< extended files: pages before the old end that HDF5 changed
  struct stat before_extending {};

  static DiskFile* of(H5FD_t* file) { return reinterpret_cast<DiskFile*>(file); }
  static const DiskFile* of(const H5FD_t* file) { return reinterpret_cast<const DiskFile*>(file); }

  static void refuse(Disk& disk) {
    if (disk.error_ == 0) disk.error_ = errno;
  }

  static H5FD_t* open(const char* name, unsigned /*flags*/, hid_t access, haddr_t /*most*/) {
    Disk* disk = *static_cast<Disk* const*>(H5Pget_driver_info(access));
    const bool extend = disk->mode_ == Disk::Mode::extend;
    const int flags = O_RDWR | O_CLOEXEC | (extend ? 0 : O_CREAT | O_TRUNC);
    const int descriptor = ::open(name, flags, 0666);
    if (descriptor < 0) {
      refuse(*disk);
      return nullptr;
    }
    auto* file = new DiskFile;
    file->disk = disk;
    file->descriptor = descriptor;
    if (extend && !file->findOldEnd()) {
      ::close(descriptor);
      delete file;
      return nullptr;
    }
    return &file->base;
  }

  /// False if another run extends the file, or if its form does not allow extension.
  bool findOldEnd() {
    const std::optional<haddr_t> known = endInSuperblock(descriptor);
    if (!known || flock(descriptor, LOCK_EX | LOCK_NB) != 0 ||
        fstat(descriptor, &before_extending) != 0 || haddr_t(before_extending.st_size) < *known) {
      return false;
    }
    disk->old_end_ = *known;
    end = haddr_t(before_extending.st_size);
    return true;
  }

  /// Switches to the new state, or cuts off everything behind the old end if it must not switch.
  void finishExtending() {
    Page before{};
    for (auto page = pages.begin(); page != pages.end();) {
      readAll(descriptor, page->first, before.data(), kPage);
      page = before == page->second ? pages.erase(page) : std::next(page);
    }
    const bool first_page_alone = pages.size() == 1 && pages.begin()->first == 0;
    if (!disk->may_switch_ || disk->error_ != 0 || !first_page_alone) {
      // We restore the times, too, so that the file does not look changed.
      const timespec times[] = {before_extending.st_atim, before_extending.st_mtim};
      if (ftruncate(descriptor, before_extending.st_size) != 0 ||
          futimens(descriptor, times) != 0) {
        refuse(*disk);
      }
      return;
    }
    // The data to which the page refers must be on the disk before it.
    const Page& page = pages.begin()->second;
    if (fdatasync(descriptor) != 0 || pwrite(descriptor, page.data(), kPage, 0) != kPage ||
        fdatasync(descriptor) != 0) {
      refuse(*disk);
      return;
    }
    disk->switched_ = true;
  }

  static herr_t close(H5FD_t* base) {
    DiskFile* file = of(base);
    if (file->disk->mode_ == Disk::Mode::extend) file->finishExtending();
    if (::close(file->descriptor) != 0) refuse(*file->disk);
    delete file;
    return 0;
  }

  static herr_t read(H5FD_t* base, H5FD_mem_t /*type*/, hid_t /*transfer*/, haddr_t address,
                     std::size_t size, void* buffer) {
    auto* bytes = static_cast<char*>(buffer);
    readAll(of(base)->descriptor, address, bytes, size);
    for (const auto& [start, page] : of(base)->pages) {
      const haddr_t first = std::max(address, start);
      const haddr_t last = std::min({address + size, start + kPage, of(base)->disk->old_end_});
      if (first < last) std::memcpy(bytes + (first - address), &page[first - start], last - first);
    }
    return 0;
  }

  /// Keeps the part of a write that is before the old end in memory. Returns its length.
  std::size_t keepInMemory(haddr_t address, std::size_t size, const char* bytes) {
    const haddr_t last = std::min<haddr_t>(address + size, disk->old_end_);
    for (haddr_t at = address; at < last;) {
      const haddr_t start = at / kPage * kPage;
      const auto [page, added] = pages.try_emplace(start);
      if (added) readAll(descriptor, start, page->second.data(), kPage);
      const std::size_t count = std::min<haddr_t>(start + kPage, last) - at;
      std::memcpy(&page->second[at - start], bytes + (at - address), count);
      at += count;
    }
    return last > address ? std::size_t(last - address) : 0;
  }

  static herr_t write(H5FD_t* base, H5FD_mem_t type, hid_t /*transfer*/, haddr_t address,
                      std::size_t size, const void* buffer) {
    DiskFile* file = of(base);
    const auto* bytes = static_cast<const char*>(buffer);
    file->end = std::max(file->end, address + size);
    if (file->disk->reserved_ != nullptr && type == H5FD_MEM_DRAW) {
      file->disk->reserved_->push_back(address);
      return 0;
    }
    if (file->disk->mode_ == Disk::Mode::extend) {
      const std::size_t kept = file->keepInMemory(address, size, bytes);
      bytes += kept;
      address += kept;
      size -= kept;
    }
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

Disk::Disk(Mode mode) : mode_(mode) {
  static const H5FD_class_t kDriver = DiskFile::driver();
  driver_ = Handle(H5FDregister(&kDriver), H5FDunregister);
}

void Disk::serve(hid_t access) {
  Disk* self = this;
  H5Pset_driver(access, driver_.get(), &self);
}

}  // namespace radiosity::h5
