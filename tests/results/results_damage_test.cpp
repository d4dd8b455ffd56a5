// Every dataset of a results file damaged in turn, as by another program: it is refused by name, or
// the damage is of no consequence. And files that would have HDF5 read other files.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <set>
#include <span>

#include "matrix/cut_sample.h"
#include "radiosity/matrix_functions.h"
#include "results/h5.h"
#include "results_sample.h"
#include "support/results_folder.h"

namespace radiosity {
namespace {

using h5::Handle;

struct Damage;

class ResultsDamage : public FolderTest {
 protected:
  std::string file() const { return path("x.h5"); }
  void write(const Results& results) { writeResults(file(), results, progress_); }
  /// What readResults() says of the file; empty: it reads it.
  std::string refusal() const {
    try {
      readResults(file());
      return {};
    } catch (const InputError& error) {
      return error.what();
    }
  }

  struct Counts {
    std::size_t datasets = 0;
    std::size_t refused = 0;
  };
  /// Damages each dataset whose path begins so in each way. The file is then refused by name, or
  /// isGood(path, damage) says that it may be so.
  template <class IsGood>
  Counts damageAll(const Results& whole, const std::string& below, const IsGood& isGood);
};

/// A dataset as other programs see it: its own type, its extent and its bytes.
struct Values {
  Handle type;
  std::vector<hsize_t> extent;
  std::vector<unsigned char> bytes;

  std::size_t width() const { return H5Tget_size(type.get()); }
  std::size_t rowBytes() const {
    std::size_t size = width();
    for (std::size_t k = 1; k < extent.size(); ++k) size *= extent[k];
    return size;
  }
  std::size_t count() const { return bytes.size() / width(); }
  void resizeRows(std::size_t rows) {
    bytes.resize(rows * rowBytes());
    extent[0] = rows;
  }
};

Values valuesOf(hid_t file, const std::string& path) {
  const Handle id(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose);
  const Handle space(H5Dget_space(id.get()), H5Sclose);
  Values values{Handle(H5Dget_type(id.get()), H5Tclose), {}, {}};
  values.extent.resize(std::size_t(H5Sget_simple_extent_ndims(space.get())));
  H5Sget_simple_extent_dims(space.get(), values.extent.data(), nullptr);
  values.bytes.resize(values.extent[0] * values.rowBytes());
  if (!values.bytes.empty()) {
    EXPECT_GE(
        H5Dread(id.get(), values.type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.bytes.data()),
        0);
  }
  return values;
}

/// Puts a dataset in the place of another.
void replace(hid_t file, const std::string& path, const Values& values) {
  EXPECT_GE(H5Ldelete(file, path.c_str(), H5P_DEFAULT), 0);
  const Handle space(H5Screate_simple(int(values.extent.size()), values.extent.data(), nullptr),
                     H5Sclose);
  const Handle id(H5Dcreate2(file, path.c_str(), values.type.get(), space.get(), H5P_DEFAULT,
                             H5P_DEFAULT, H5P_DEFAULT),
                  H5Dclose);
  if (values.bytes.empty()) return;
  EXPECT_GE(
      H5Dwrite(id.get(), values.type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.bytes.data()), 0);
}

/// By every link: some datasets have two.
std::vector<std::string> datasetsOf(hid_t file) {
  std::vector<std::string> paths;
  const auto keep = [](hid_t group, const char* name, const H5L_info_t*, void* data) -> herr_t {
    const Handle id(H5Oopen(group, name, H5P_DEFAULT), H5Oclose);
    if (H5Iget_type(id.get()) == H5I_DATASET) {
      static_cast<std::vector<std::string>*>(data)->push_back(std::string("/") + name);
    }
    return 0;
  };
  H5Lvisit(file, H5_INDEX_NAME, H5_ITER_INC, keep, &paths);
  return paths;
}

template <class T>
void put(Values& values, std::size_t at, T value) {
  std::memcpy(values.bytes.data() + at * sizeof value, &value, sizeof value);
}

void putNumber(Values& values, std::size_t at, double value) {
  values.width() == 4 ? put(values, at, float(value)) : put(values, at, value);
}

/// All bits, or all but the last: beyond every index, -1 and -2 of a signed type.
void putBits(Values& values, std::size_t at, unsigned char lowest) {
  unsigned char* start = values.bytes.data() + at * values.width();
  std::fill(start, start + values.width(), (unsigned char)(0xff));
  *start = lowest;
}

/// A way to damage a dataset; false: it does not apply to this one.
struct Damage {
  const char* name;
  bool (*apply)(Values& values);
};

bool isFloat(const Values& v) { return H5Tget_class(v.type.get()) == H5T_FLOAT; }
bool isInteger(const Values& v) { return H5Tget_class(v.type.get()) == H5T_INTEGER; }

template <int kWhich>
bool number(Values& values) {
  if (!isFloat(values) || values.bytes.empty()) return false;
  constexpr double kNumbers[] = {std::numeric_limits<double>::quiet_NaN(),
                                 std::numeric_limits<double>::infinity(), -3.0};
  putNumber(values, kWhich % 2 == 0 ? values.count() - 1 : 0, kNumbers[kWhich]);
  return true;
}

template <int kLowest, bool kLast>
bool integer(Values& values) {
  if (!isInteger(values) || values.bytes.empty()) return false;
  putBits(values, kLast ? values.count() - 1 : 0, kLowest);
  return true;
}

template <int kMore>
bool rows(Values& values) {
  if (values.extent[0] == 0) return false;
  values.resizeRows(values.extent[0] + std::size_t(kMore));
  return true;
}

bool noRows(Values& values) {
  if (values.extent[0] == 0) return false;
  values.resizeRows(0);
  return true;
}

bool otherType(Values& values) {
  const bool single = isFloat(values) && values.width() == 4;
  values.type = Handle(H5Tcopy(single ? H5T_NATIVE_DOUBLE : H5T_NATIVE_FLOAT), H5Tclose);
  values.resizeRows(values.extent[0]);
  std::fill(values.bytes.begin(), values.bytes.end(), (unsigned char)(0));
  return true;
}

bool turnedDimensions(Values& values) {
  values.extent = values.extent.size() == 1
                      ? std::vector<hsize_t>{values.extent[0], 1}
                      : std::vector<hsize_t>{values.extent[0] * values.extent[1]};
  return true;
}

constexpr Damage kDamages[] = {
    {"NaN at the end", number<0>},
    {"infinity at the front", number<1>},
    {"negative at the end", number<2>},
    {"all bits at the front", integer<0xff, false>},
    {"all bits at the end", integer<0xff, true>},
    {"all bits but one at the end", integer<0xfe, true>},
    {"one row less", rows<-1>},
    {"one row more", rows<1>},
    {"no rows", noRows},
    {"another type", otherType},
    {"other dimensions", turnedDimensions},
};

bool endsWithOneOf(const std::string& path, std::span<const char* const> ends) {
  return std::ranges::any_of(ends, [&](const char* end) { return path.ends_with(end); });
}

/// Whether a file may be so: nothing tells the damage from a value that there could be.
bool mayBe(const std::string& path, const std::string& damage) {
  // Places, differences, light that a solver leaves below 0 by its tolerance, and heat.
  constexpr const char* kSigned[] = {"/vertices",   "/texcoords",
                                     "/centroid",   "/origin",
                                     "/position",   "/eye",
                                     "/target",     "/up",
                                     "/radiosity",  "/irradiance",
                                     "/values",     "/net_flux",
                                     "/convection", "/temperature",
                                     "/emitted",    "/from_sky",
                                     "/absorbed",   "/to_sky",
                                     "/on_backs",   "/imbalance",
                                     "/in_flight",  "/residual_history",
                                     "/seconds",    "/change",
                                     "/bound",      "/given",
                                     "/kept",       "/buried",
                                     "/overlapped", "/degenerate"};
  if (damage.starts_with("negative")) return endsWithOneOf(path, kSigned);
  // NaN stands for a missing number.
  constexpr const char* kGaps[] = {"/bound", "/temperature"};
  if (damage.starts_with("NaN")) return endsWithOneOf(path, kGaps);
  // kNone is for none: a material without a texture.
  constexpr const char* kNoneAllowed[] = {"/texture", "/emission_texture"};
  if (damage.starts_with("all bits at")) {
    if (endsWithOneOf(path, kNoneAllowed)) return true;
  }
  // Any number: lines of a file.
  if (damage.starts_with("all bits")) return path == "/scene/face_element";
  // As many as there are, or none.
  constexpr const char* kAnyLength[] = {"/residual_history", "/condition_settings",
                                        "/condition_groups", "/condition_table",
                                        "/photometric_lights"};
  if (damage.find("row") != std::string::npos && endsWithOneOf(path, kAnyLength)) return true;
  constexpr const char* kOrNone[] = {"/texcoords", "/colours", "/form_factors/error",
                                     "/form_factors/backs_by_surface"};
  // Points that no element or face names are of no consequence.
  const bool of_points = path.ends_with("/points") || path == "/scene/vertices";
  if (damage == "one row more" && of_points) return true;
  return damage == "no rows" && endsWithOneOf(path, kOrNone);
}

template <class IsGood>
ResultsDamage::Counts ResultsDamage::damageAll(const Results& whole, const std::string& below,
                                               const IsGood& isGood) {
  write(whole);
  const std::vector<char> bytes = load(file());
  std::vector<std::string> paths;
  {
    const Handle open(H5Fopen(file().c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    paths = datasetsOf(open.get());
  }
  Counts counts;
  for (const std::string& object : paths) {
    if (!object.starts_with(below)) continue;
    ++counts.datasets;
    for (const Damage& damage : kDamages) {
      save(file(), bytes);
      {
        const Handle open(H5Fopen(file().c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
        Values values = valuesOf(open.get(), object);
        if (!damage.apply(values)) continue;
        replace(open.get(), object, values);
      }
      SCOPED_TRACE(object + ": " + damage.name);
      const std::string message = refusal();
      if (message.empty()) {
        EXPECT_TRUE(isGood(object, damage)) << "read";
        continue;
      }
      ++counts.refused;
      EXPECT_TRUE(message.starts_with(file() + ": /")) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
  return counts;
}

TEST_F(ResultsDamage, OfEveryDatasetIsRefusedByNameOrOfNoConsequence) {
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    const Results good = sample::results(3, precision);
    const auto [datasets, refused] =
        damageAll(good, "/", [&](const std::string& object, const Damage& damage) {
          return mayBe(object, damage.name) || sample::same(good, readResults(file()));
        });
    ASSERT_GT(datasets, 100U);
    EXPECT_GT(refused, 5 * datasets);
  }
}

TEST_F(ResultsDamage, OfRowsThatAreCutIsRefusedByNameOrLeavesRows) {
  Results good = sample::results(3, Precision::single_precision);
  good.factors->matrix =
      std::make_shared<CutOperator>(test::randomCut(good.factors->fronts.size(), 1));
  const auto [datasets, refused] =
      damageAll(good, "/form_factors/cut", [&](const std::string&, const Damage&) {
        // Other hits, places or features are rows of other rays.
        const std::vector<double> sums = readResults(file()).factors->matrix->rowSums();
        return sums.size() == good.factors->fronts.size() &&
               std::ranges::all_of(sums, [](double sum) { return std::isfinite(sum); });
      });
  EXPECT_EQ(datasets, 14U);
  EXPECT_GT(refused, 4 * datasets);
}

/// A file of ours to which `change` is done with HDF5 itself.
template <class Change>
void edit(const std::string& path, const Change& change) {
  const Handle open(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  change(open.get());
}

constexpr const char* kObject = "/mesh/area";

void addExternalStorage(hid_t file, const std::string& other) {
  const Values values = valuesOf(file, kObject);
  H5Ldelete(file, kObject, H5P_DEFAULT);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_external(creation.get(), other.c_str(), 0, values.bytes.size());
  const Handle space(H5Screate_simple(1, values.extent.data(), nullptr), H5Sclose);
  H5Dclose(H5Dcreate2(file, kObject, values.type.get(), space.get(), H5P_DEFAULT, creation.get(),
                      H5P_DEFAULT));
}

void addVirtual(hid_t file, const std::string& other) {
  const Values values = valuesOf(file, kObject);
  H5Ldelete(file, kObject, H5P_DEFAULT);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const Handle space(H5Screate_simple(1, values.extent.data(), nullptr), H5Sclose);
  H5Pset_virtual(creation.get(), space.get(), other.c_str(), kObject, space.get());
  H5Dclose(H5Dcreate2(file, kObject, values.type.get(), space.get(), H5P_DEFAULT, creation.get(),
                      H5P_DEFAULT));
}

void addFilter(hid_t file, const std::string& /*other*/) {
  Values values = valuesOf(file, kObject);
  H5Ldelete(file, kObject, H5P_DEFAULT);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_chunk(creation.get(), 1, values.extent.data());
  H5Pset_shuffle(creation.get());
  const Handle space(H5Screate_simple(1, values.extent.data(), nullptr), H5Sclose);
  const Handle id(H5Dcreate2(file, kObject, values.type.get(), space.get(), H5P_DEFAULT,
                             creation.get(), H5P_DEFAULT),
                  H5Dclose);
  H5Dwrite(id.get(), values.type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.bytes.data());
}

void linkOutside(hid_t file, const std::string& other) {
  H5Ldelete(file, kObject, H5P_DEFAULT);
  H5Lcreate_external(other.c_str(), kObject, file, kObject, H5P_DEFAULT, H5P_DEFAULT);
}

void linkByName(hid_t file, const std::string& /*other*/) {
  H5Lmove(file, kObject, file, "/mesh/elsewhere", H5P_DEFAULT, H5P_DEFAULT);
  H5Lcreate_soft("/mesh/elsewhere", file, kObject, H5P_DEFAULT, H5P_DEFAULT);
}

TEST_F(ResultsDamage, NoOtherFileIsRead) {
  write(sample::results(3, Precision::single_precision));
  const std::vector<char> whole = load(file());
  const std::string other = path("other.h5");
  save(other, whole);
  const std::string at = file() + ": " + kObject + " ";
  const std::tuple<void (*)(hid_t, const std::string&), const char*> kWays[] = {
      {addExternalStorage, "has its values in another file"},
      {addVirtual, "is put together from other files"},
      {addFilter, "passes through the filter 2"},
      {linkOutside, "is a link to another file"},
      {linkByName, "is a link by name"}};
  const Results results = sample::results(3, Precision::single_precision);
  for (const auto& [way, words] : kWays) {
    save(file(), whole);
    edit(file(), [&, change = way](hid_t open) { change(open, other); });
    const std::string said = refusal();
    EXPECT_TRUE(said.starts_with(at + words)) << said;
    // Neither is such a file extended, nor taken for another program's.
    const std::vector<char> before = load(file());
    EXPECT_FALSE(updateResults(file(), results, false));
    EXPECT_EQ(before, load(file()));
    EXPECT_FALSE(isForeignHdf5(file()));
    EXPECT_FALSE(sceneInResults(file()));
  }
  EXPECT_EQ(whole, load(other));
}

TEST_F(ResultsDamage, AGroupLinkedOutsideIsNotExtended) {
  const Results results = sample::results(3, Precision::single_precision);
  write(results);
  const std::string other = path("other.h5");
  std::filesystem::copy(file(), other);
  const std::vector<char> whole = load(other);
  for (const char* group : {"/mesh", "/form_factors", "/solution"}) {
    write(results);
    edit(file(), [&](hid_t open) {
      H5Ldelete(open, group, H5P_DEFAULT);
      H5Lcreate_external(other.c_str(), group, open, group, H5P_DEFAULT, H5P_DEFAULT);
    });
    EXPECT_TRUE(refusal().starts_with(file() + ": " + group + " is a link to another file"));
    EXPECT_FALSE(updateResults(file(), results, false));
    EXPECT_EQ(whole, load(other));
  }
}

TEST_F(ResultsDamage, GroupsWithoutEndAreRefused) {
  write(sample::results(3, Precision::single_precision));
  edit(file(), [](hid_t open) {
    H5Lcreate_hard(open, "/mesh", open, "/mesh/again", H5P_DEFAULT, H5P_DEFAULT);
  });
  EXPECT_NE(refusal().find("has groups without end"), std::string::npos) << refusal();
}

TEST_F(ResultsDamage, ANumberThatOverflowsIsRefused) {
  write(sample::results(3, Precision::single_precision, 2));
  edit(file(), [](hid_t open) {
    // 2^63 vertices of 2 bands are 0 values again.
    const Handle group(H5Gopen2(open, "/elements/direct", H5P_DEFAULT), H5Gclose);
    const Handle id(H5Aopen(group.get(), "vertices", H5P_DEFAULT), H5Aclose);
    const std::uint64_t vertices = std::uint64_t(1) << 63;
    EXPECT_GE(H5Awrite(id.get(), H5T_NATIVE_UINT64, &vertices), 0);
    Values values = valuesOf(open, "/elements/direct/values");
    values.resizeRows(0);
    replace(open, "/elements/direct/values", values);
  });
  const std::string said = refusal();
  EXPECT_TRUE(said.starts_with(file() + ": /elements/direct/")) << said;
}

}  // namespace
}  // namespace radiosity
