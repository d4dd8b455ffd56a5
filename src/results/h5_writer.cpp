#include "results/h5_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "results/h5_contents.h"

namespace radiosity::h5 {

namespace {

/// Fixed-length UTF-8, padded with zeros. Strings of variable length would be in HDF5's global
/// heap, the only part without a checksum.
Handle stringType(std::size_t width) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), std::max<std::size_t>(width, 1));
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  return type;
}

Handle spaceOf(const Shape& shape) {
  const hsize_t extent[2] = {shape.rows, shape.columns};
  return {H5Screate_simple(shape.columns == 0 ? 1 : 2, extent, nullptr), H5Sclose};
}

/// Compact if small; else chunked, with a checksum for each chunk.
Handle layoutOf(const Shape& shape, std::size_t bytes, std::size_t chunk_rows) {
  Handle list(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(list.get(), false);  // so that the same results give the same file
  if (bytes <= kCompactBytes) {
    H5Pset_layout(list.get(), H5D_COMPACT);
    return list;
  }
  const hsize_t chunk[2] = {chunk_rows, shape.columns};
  H5Pset_chunk(list.get(), shape.columns == 0 ? 1 : 2, chunk);
  H5Pset_fletcher32(list.get());
  H5Pset_fill_time(list.get(), H5D_FILL_TIME_NEVER);  // every element is written
  return list;
}

}  // namespace

namespace {

/// Room for the groups and attributes of the root in the file's first page (Disk); HDF5 uses the
/// product. Without it an added group would be elsewhere, and the next one could not be added.
constexpr unsigned kRootLinks = 8;
constexpr unsigned kRootNames = 160;
/// The most members and attributes that a group holds in its header. HDF5 keeps more of them in
/// trees and heaps, which it writes to when it removes the group: outside the file's first page.
constexpr unsigned kHeaderMembers = 64;

void keepInHeader(hid_t creation) {
  H5Pset_link_phase_change(creation, kHeaderMembers, kHeaderMembers / 2);
  H5Pset_attr_phase_change(creation, kHeaderMembers, kHeaderMembers / 2);
}

Handle accessTo(Disk& disk) {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(access.get(), H5F_LIBVER_V110, H5F_LIBVER_V110);
  H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG);
  disk.serve(access.get());
  return access;
}

}  // namespace

OutputFile::OutputFile(const std::string& path, std::string shown)
    : path_(path), shown_(std::move(shown)) {
  const Handle access = accessTo(disk_);
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.get(), false);  // of the root group
  H5Pset_est_link_info(creation.get(), kRootLinks, kRootNames);
  keepInHeader(creation.get());
  file_ = Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose);
  if (!file_) fail("/");
}

std::unique_ptr<OutputFile> OutputFile::extend(const std::string& path) {
  std::unique_ptr<OutputFile> file(new OutputFile(Disk::Mode::extend));
  file->path_ = path;
  file->shown_ = path;
  const Handle access = accessTo(file->disk_);
  file->file_ = Handle(H5Fopen(path.c_str(), H5F_ACC_RDWR, access.get()), H5Fclose);
  if (!file->file_ || foreignObject(file->id())) return nullptr;
  return file;
}

bool OutputFile::closeExtended() {
  check("/");
  disk_.allowSwitch();
  const bool closed = file_.close();
  check("/");
  return closed && disk_.switched();
}

const ChunkFile& OutputFile::chunks() {
  if (!chunks_) chunks_.emplace(path_, shown_);
  return *chunks_;
}

void OutputFile::close() {
  if (chunks_) chunks_->close();
  if (!file_.close()) fail("/");
  check("/");
}

void OutputFile::fail(const std::string& object) const {
  const std::string reason = disk_.error() != 0 ? std::strerror(disk_.error()) : lastError();
  throw RunError(fmt::format("{}: {} cannot be written: {}", shown_, object, reason));
}

OutputGroup::OutputGroup(OutputFile& file)
    : file_(&file), id_(H5Gopen2(file.id(), "/", H5P_DEFAULT), H5Gclose) {
  if (!id_) file.fail("/");
}

OutputGroup::OutputGroup(OutputFile& file, Handle id, std::string path)
    : file_(&file), id_(std::move(id)), path_(std::move(path)) {}

Handle OutputGroup::checked(hid_t id, Handle::Close close, const std::string& name) const {
  if (id < 0) file_->fail(pathOf(name));
  return {id, close};
}

OutputGroup OutputGroup::group(const std::string& name) {
  const Handle list(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_obj_track_times(list.get(), false);
  keepInHeader(list.get());
  Handle id = checked(H5Gcreate2(id_.get(), name.c_str(), H5P_DEFAULT, list.get(), H5P_DEFAULT),
                      H5Gclose, name);
  return {*file_, std::move(id), pathOf(name)};
}

void OutputGroup::attribute(const std::string& name, Number number, std::size_t count,
                            const void* data) {
  const hsize_t extent = count;
  const Handle space(count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &extent, nullptr),
                     H5Sclose);
  const Handle id = checked(
      H5Acreate2(id_.get(), name.c_str(), typeOf(number), space.get(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose, name);
  if (H5Awrite(id.get(), typeOf(number), data) < 0) file_->fail(pathOf(name));
}

void OutputGroup::text(const std::string& name, const std::string& value) {
  writeText(id_.get(), name, value);
}

void OutputGroup::writeText(hid_t object, const std::string& name, const std::string& value) {
  const Handle type = stringType(value.size());
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle id =
      checked(H5Acreate2(object, name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
              H5Aclose, name);
  if (H5Awrite(id.get(), type.get(), value.c_str()) < 0) file_->fail(pathOf(name));
}

Handle OutputGroup::create(const std::string& name, const Shape& shape, const std::string& unit) {
  const Handle space = spaceOf(shape);
  const Handle list = layoutOf(shape, shape.bytes(), chunkRows(shape));
  Handle id = checked(H5Dcreate2(id_.get(), name.c_str(), typeOf(shape.number), space.get(),
                                 H5P_DEFAULT, list.get(), H5P_DEFAULT),
                      H5Dclose, name);
  if (!unit.empty()) writeText(id.get(), "unit", unit);
  return id;
}

void OutputGroup::dataset(const std::string& name, const Shape& shape, const void* data,
                          const std::string& unit) {
  Handle id = create(name, shape, unit);
  if (shape.count() > 0 &&
      H5Dwrite(id.get(), typeOf(shape.number), H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) {
    file_->fail(pathOf(name));
  }
  if (!id.close()) file_->fail(pathOf(name));
  file_->check(pathOf(name));
}

ReservedColumn OutputGroup::reserve(const std::string& name, Number number, std::size_t count) {
  const Shape shape{number, count, 0};
  if (shape.bytes() <= kCompactBytes) {
    throw std::logic_error("OutputGroup::reserve(): a compact dataset has no chunks");
  }
  ReservedColumn column{pathOf(name), chunkRows(shape), {}};
  Handle id = create(name, shape, "");
  const std::vector<unsigned char> bytes(column.chunk * sizeOf(number));
  const std::vector<unsigned char> stored = storedChunk(bytes);
  const Disk::Reserving reserving(file_->disk(), column.places);
  constexpr std::uint32_t kAllFilters = 0;  // none was left out
  for (hsize_t first = 0; first < count; first += column.chunk) {
    if (H5Dwrite_chunk(id.get(), H5P_DEFAULT, kAllFilters, &first, stored.size(), stored.data()) <
        0) {
      file_->fail(column.path);
    }
  }
  if (!id.close()) file_->fail(column.path);
  file_->check(column.path);
  return column;
}

std::size_t columnWidth(const std::vector<std::string>& values) {
  std::size_t width = 1;
  for (const std::string& value : values) width = std::max(width, value.size());
  return width;
}

void OutputGroup::strings(const std::string& name, const std::vector<std::string>& values) {
  const std::size_t width = columnWidth(values);
  const Handle type = stringType(width);
  std::vector<char> padded(values.size() * width, '\0');
  for (std::size_t k = 0; k < values.size(); ++k) {
    std::memcpy(padded.data() + k * width, values[k].data(), values[k].size());
  }
  const Shape shape{Number::u8, values.size(), 0};
  const Handle space = spaceOf(shape);
  const Handle list = layoutOf(shape, padded.size(), chunkRows({Number::u8, values.size(), width}));
  Handle id = checked(H5Dcreate2(id_.get(), name.c_str(), type.get(), space.get(), H5P_DEFAULT,
                                 list.get(), H5P_DEFAULT),
                      H5Dclose, name);
  if (!padded.empty() &&
      H5Dwrite(id.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, padded.data()) < 0) {
    file_->fail(pathOf(name));
  }
  if (!id.close()) file_->fail(pathOf(name));
  file_->check(pathOf(name));
}

void OutputGroup::link(const std::string& name, const OutputGroup& target,
                       const std::string& target_name) {
  if (H5Lcreate_hard(target.id_.get(), target_name.c_str(), id_.get(), name.c_str(), H5P_DEFAULT,
                     H5P_DEFAULT) < 0) {
    file_->fail(pathOf(name));
  }
}

bool OutputGroup::has(const std::string& name) const {
  return H5Lexists(id_.get(), name.c_str(), H5P_DEFAULT) > 0;
}

void OutputGroup::replace(const std::string& name, const std::string& fresh) {
  if (has(name)) remove(name);
  if (H5Lmove(id_.get(), fresh.c_str(), id_.get(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT) < 0) {
    file_->fail(pathOf(name));
  }
}

void OutputGroup::remove(const std::string& name) {
  if (H5Ldelete(id_.get(), name.c_str(), H5P_DEFAULT) < 0) file_->fail(pathOf(name));
}

std::optional<std::uint64_t> OutputGroup::number(const std::string& name) const {
  if (H5Aexists(id_.get(), name.c_str()) <= 0) return std::nullopt;
  const Handle id(H5Aopen(id_.get(), name.c_str(), H5P_DEFAULT), H5Aclose);
  std::uint64_t value = 0;
  if (!id || H5Aread(id.get(), typeOf(Number::u64), &value) < 0) return std::nullopt;
  return value;
}

bool OutputGroup::says(const std::string& group, const std::string& name,
                       const std::string& value) const {
  const Handle id(H5Aopen_by_name(id_.get(), group.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                  H5Aclose);
  if (!id) return false;
  const Handle type(H5Aget_type(id.get()), H5Tclose);
  if (H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) != 0) return false;
  std::string found(H5Tget_size(type.get()), '\0');
  if (H5Aread(id.get(), type.get(), found.data()) < 0) return false;
  return found.substr(0, found.find_last_not_of('\0') + 1) == value;
}

// The bytes that HDF5 1.10 takes for each object besides its data, measured on files of ours: the
// object header with its messages, and the link in its group.
namespace {
constexpr std::size_t kGroupBytes = 130;
constexpr std::size_t kAttributeBytes = 35;
constexpr std::size_t kDatasetBytes = 280;
constexpr std::size_t kChunkOverhead = 24;  // index entry and checksum
}  // namespace

SizeCounter SizeCounter::group(const std::string& name) {
  *bytes_ += kGroupBytes + name.size();
  return *this;
}

void SizeCounter::attribute(const std::string& name, Number number, std::size_t count,
                            const void* /*data*/) {
  *bytes_ += kAttributeBytes + name.size() + count * sizeOf(number);
}

void SizeCounter::text(const std::string& name, const std::string& value) {
  *bytes_ += kAttributeBytes + name.size() + value.size();
}

void SizeCounter::raw(const std::string& name, const Shape& shape, const std::string& unit) {
  *bytes_ += kDatasetBytes + name.size();
  if (!unit.empty()) text("unit", unit);
  if (shape.bytes() <= kCompactBytes) {
    *bytes_ += shape.bytes();
    return;
  }
  const std::size_t chunk = chunkRows(shape);
  const std::size_t chunks = (shape.rows + chunk - 1) / chunk;
  *bytes_ += chunks * (chunk * shape.perRow() * sizeOf(shape.number) + kChunkOverhead);
}

void SizeCounter::dataset(const std::string& name, const Shape& shape, const void* /*data*/,
                          const std::string& unit) {
  raw(name, shape, unit);
}

void SizeCounter::strings(const std::string& name, const std::vector<std::string>& values) {
  raw(name, {Number::u8, values.size(), columnWidth(values)}, "");
}

void SizeCounter::link(const std::string& name, const SizeCounter& /*target*/,
                       const std::string& /*target_name*/) {
  *bytes_ += 20 + name.size();
}

}  // namespace radiosity::h5
