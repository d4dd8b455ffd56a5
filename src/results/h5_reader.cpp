#include "results/h5_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "base/input_file.h"
#include "radiosity/results.h"
#include "results/h5_contents.h"

namespace radiosity::h5 {

namespace {

constexpr const char* kCure = "make the file again with the command that wrote it";

}  // namespace

InputFile::InputFile(const std::string& path) : path_(path) {
  requireFile(path);
  if (!isResultsFile(path)) {
    throw InputError(fmt::format(
        "{}: is not a results file (not HDF5); name a .h5 file written by radiosity", path));
  }
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG);
  // No lock is needed: a finished results file is replaced, or extended behind its end and switched
  // in one write (h5_disk.h).
  H5Pset_file_locking(access.get(), false, true);
  file_ = Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
  if (!file_) {
    silence_.keepForGood();
    throw InputError(fmt::format("{}: is truncated or damaged ({}); {}", path, lastError(), kCure));
  }
}

void InputFile::fail(const std::string& object, const std::string& what) const {
  throw InputError(fmt::format("{}: {} {}; {}", path_, object, what, kCure));
}

void InputFile::failDamaged(const std::string& object) const {
  silence_.keepForGood();
  fail(object, fmt::format("is damaged ({})", lastError()));
}

std::size_t InputFile::bytes() const {
  hsize_t size = 0;
  return H5Fget_filesize(id(), &size) < 0 ? 0 : std::size_t(size);
}

void InputFile::requireOwnObjects() const {
  if (const auto foreign = foreignObject(id())) fail(foreign->path, foreign->what);
}

InputGroup::InputGroup(const InputFile& file)
    : file_(&file), id_(H5Gopen2(file.id(), "/", H5P_DEFAULT), H5Gclose) {
  if (!id_) file.failDamaged("/");
}

InputGroup::InputGroup(const InputFile& file, Handle id, std::string path)
    : file_(&file), id_(std::move(id)), path_(std::move(path)) {}

Handle InputGroup::checked(hid_t id, Handle::Close close, const std::string& name) const {
  if (id < 0) file_->failDamaged(pathOf(name));
  return {id, close};
}

bool InputGroup::has(const std::string& name) const {
  const htri_t found = H5Lexists(id_.get(), name.c_str(), H5P_DEFAULT);
  if (found < 0) file_->failDamaged(pathOf(name));
  return found > 0;
}

bool InputGroup::hasAttribute(const std::string& name) const {
  const htri_t found = H5Aexists(id_.get(), name.c_str());
  if (found < 0) file_->failDamaged(pathOf(name));
  return found > 0;
}

InputGroup InputGroup::group(const std::string& name) const {
  if (!has(name)) fail(name, "is missing");
  return {*file_, checked(H5Gopen2(id_.get(), name.c_str(), H5P_DEFAULT), H5Gclose, name),
          pathOf(name)};
}

void InputGroup::attribute(const std::string& name, Number number, std::size_t count,
                           void* data) const {
  if (!hasAttribute(name)) fail(name, "is missing");
  const Handle id = checked(H5Aopen(id_.get(), name.c_str(), H5P_DEFAULT), H5Aclose, name);
  const Handle type = checked(H5Aget_type(id.get()), H5Tclose, name);
  const Handle space = checked(H5Aget_space(id.get()), H5Sclose, name);
  if (H5Tequal(type.get(), typeOf(number)) <= 0 ||
      H5Sget_simple_extent_npoints(space.get()) != hssize_t(count)) {
    fail(name, fmt::format("is not {} {}", count, nameOf(number)));
  }
  if (H5Aread(id.get(), typeOf(number), data) < 0) file_->failDamaged(pathOf(name));
}

std::string InputGroup::text(const std::string& name) const {
  if (!hasAttribute(name)) fail(name, "is missing");
  const Handle id = checked(H5Aopen(id_.get(), name.c_str(), H5P_DEFAULT), H5Aclose, name);
  const Handle type = checked(H5Aget_type(id.get()), H5Tclose, name);
  const Handle space = checked(H5Aget_space(id.get()), H5Sclose, name);
  if (H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) != 0 ||
      H5Sget_simple_extent_npoints(space.get()) != 1) {
    fail(name, "is not a text of fixed length");
  }
  if (H5Tget_size(type.get()) > file_->bytes()) fail(name, "claims more bytes than the file has");
  std::string value(H5Tget_size(type.get()), '\0');
  if (H5Aread(id.get(), type.get(), value.data()) < 0) file_->failDamaged(pathOf(name));
  value.resize(value.find_last_not_of('\0') + 1);  // removes the padding; npos + 1 is 0
  return value;
}

Handle InputGroup::openAny(const std::string& name, std::vector<hsize_t>& extent) const {
  if (!has(name)) fail(name, "is missing");
  Handle id = checked(H5Dopen2(id_.get(), name.c_str(), H5P_DEFAULT), H5Dclose, name);
  const Handle space = checked(H5Dget_space(id.get()), H5Sclose, name);
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank < 0) file_->failDamaged(pathOf(name));
  extent.assign(std::size_t(rank), 0);
  H5Sget_simple_extent_dims(space.get(), extent.data(), nullptr);
  return id;
}

/// Refuses a dataset that the file cannot hold, before memory is allocated: an extent is easily
/// forged.
void InputGroup::checkStorage(const std::string& name, const Handle& dataset, std::size_t rows,
                              std::size_t row_bytes) const {
  const std::size_t stored =
      std::min<std::size_t>(H5Dget_storage_size(dataset.get()), file_->bytes());
  // We compare doubles, since a forged product overflows integers.
  if (double(rows) * double(row_bytes) > double(stored)) {
    fail(name, fmt::format("claims {} rows in {} bytes", rows, stored));
  }
}

void InputGroup::failAt(const std::string& name, std::size_t row, double value) const {
  fail(name, fmt::format("holds {} at {}", value, row));
}

Handle InputGroup::open(const std::string& name, Number number, std::size_t columns,
                        std::size_t& rows) const {
  std::vector<hsize_t> extent;
  Handle id = openAny(name, extent);
  const Handle type = checked(H5Dget_type(id.get()), H5Tclose, name);
  const bool shaped =
      columns == 0 ? extent.size() == 1 : extent.size() == 2 && extent[1] == columns;
  if (!shaped || H5Tequal(type.get(), typeOf(number)) <= 0) {
    fail(name, columns == 0 ? fmt::format("is not a vector of {}", nameOf(number))
                            : fmt::format("is not {} columns of {}", columns, nameOf(number)));
  }
  const Shape shape{number, extent[0], columns};
  checkStorage(name, id, shape.rows, shape.perRow() * sizeOf(number));
  rows = shape.rows;
  return id;
}

int InputGroup::columns(const std::string& name) const {
  constexpr hsize_t kMost = 1U << 20U;  // more numbers than in any row
  std::vector<hsize_t> extent;
  openAny(name, extent);
  if (extent.size() != 2 || extent[1] < 1 || extent[1] > kMost) fail(name, "has no rows of bands");
  return int(extent[1]);
}

std::optional<Number> InputGroup::numberOfDataset(const std::string& name) const {
  std::vector<hsize_t> extent;
  const Handle id = openAny(name, extent);
  const Handle type = checked(H5Dget_type(id.get()), H5Tclose, name);
  for (const Number number :
       {Number::f32, Number::f64, Number::u8, Number::i32, Number::u32, Number::i64, Number::u64}) {
    if (H5Tequal(type.get(), typeOf(number)) > 0) return number;
  }
  return std::nullopt;
}

void InputGroup::readAll(const std::string& name, const Handle& dataset, Number number,
                         void* data) const {
  if (H5Dread(dataset.get(), typeOf(number), H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) {
    file_->failDamaged(pathOf(name));
  }
}

void InputGroup::readRows(const std::string& name, const Handle& dataset, Number number,
                          std::size_t first, std::size_t count, void* data) const {
  const Handle space(H5Dget_space(dataset.get()), H5Sclose);
  const hsize_t start = first;
  const hsize_t extent = count;
  const Handle memory(H5Screate_simple(1, &extent, nullptr), H5Sclose);
  if (H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, &start, nullptr, &extent, nullptr) < 0 ||
      H5Dread(dataset.get(), typeOf(number), memory.get(), space.get(), H5P_DEFAULT, data) < 0) {
    file_->failDamaged(pathOf(name));
  }
}

std::vector<std::string> InputGroup::strings(const std::string& name) const {
  std::vector<hsize_t> extent;
  const Handle id = openAny(name, extent);
  const Handle type = checked(H5Dget_type(id.get()), H5Tclose, name);
  if (extent.size() != 1 || H5Tget_class(type.get()) != H5T_STRING ||
      H5Tis_variable_str(type.get()) != 0) {
    fail(name, "is not a vector of texts of fixed length");
  }
  const std::size_t width = H5Tget_size(type.get());
  checkStorage(name, id, extent[0], width);
  std::vector<char> padded(extent[0] * width);
  if (!padded.empty() &&
      H5Dread(id.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, padded.data()) < 0) {
    file_->failDamaged(pathOf(name));
  }
  std::vector<std::string> values(extent[0]);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const std::string_view cell(padded.data() + k * width, width);
    values[k] = cell.substr(0, cell.find_last_not_of('\0') + 1);
  }
  return values;
}

}  // namespace radiosity::h5
