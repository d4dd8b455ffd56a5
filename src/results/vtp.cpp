// Writes VTK's XML PolyData (docs.vtk.org, "XML File Formats"): arrays are base64, each after the
// count of its bytes in 64 bits.
#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <set>
#include <string_view>
#include <type_traits>

#include "base/base64.h"
#include "base/printable.h"
#include "radiosity/vtk.h"
#include "results/checked_file.h"

namespace radiosity {

namespace {

template <class Value>
constexpr std::string_view typeName() {
  if constexpr (std::is_same_v<Value, double>) return "Float64";
  if constexpr (std::is_same_v<Value, std::int64_t>) return "Int64";
  return "UInt8";
}

class VtpFile {
 public:
  explicit VtpFile(const std::string& path) : file_(path) {}

  void write(std::string_view text) { file_.write(text); }
  void commit() { file_.commit(); }

  template <class Value>
  void array(const std::string& name, const std::vector<Value>& values, int components = 1,
             const std::string& unit = "") {
    write(fmt::format(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="binary">)",
                      typeName<Value>(), markupText(name), components));
    writeBytes(values.data(), values.size() * sizeof(Value));
    if (!unit.empty()) {
      write(fmt::format(
          R"(<InformationKey name="UNITS_LABEL" location="vtkDataArray">{}</InformationKey>)",
          markupText(unit)));
    }
    write("</DataArray>\n");
  }

  /// Writes strings, each with a final 0.
  void strings(const std::string& name, const std::vector<std::string>& values) {
    std::string text;
    for (const std::string& value : values) {
      text += value;
      text += '\0';
    }
    write(fmt::format(R"(<Array type="String" Name="{}" NumberOfTuples="{}" format="binary">)",
                      markupText(name), values.size()));
    writeBytes(text.data(), text.size());
    write("</Array>\n");
  }

 private:
  void writeBytes(const void* data, std::size_t size) {
    const std::uint64_t header = size;
    std::string bytes(reinterpret_cast<const char*>(&header), sizeof header);
    if (size > 0) bytes.append(static_cast<const char*>(data), size);
    write(base64(bytes));
  }

  CheckedFile file_;
};

template <class Value, class From>
std::vector<Value> as(const std::vector<From>& values) {
  return {values.begin(), values.end()};
}

void writeGeometry(VtpFile& file, const PatchMesh& mesh) {
  std::vector<double> points;
  points.reserve(3 * mesh.vertices.size());
  for (const Vec3& v : mesh.vertices) points.insert(points.end(), {v.x, v.y, v.z});
  file.write("<Points>\n");
  file.array("points", points, 3, "m");
  file.write("</Points>\n<Polys>\n");
  file.array("connectivity", as<std::int64_t>(mesh.corners));
  std::vector<std::int64_t> ends(mesh.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) ends[i] = std::int64_t(mesh.corner_offset[i + 1]);
  file.array("offsets", ends);
  file.write("</Polys>\n");
}

void writeIdentity(VtpFile& file, const PatchMesh& mesh) {
  std::vector<std::int64_t> numbers(mesh.size());
  std::vector<std::string> names(mesh.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    numbers[i] = std::int64_t(i);
    names[i] = mesh.surface_names[mesh.surface[i]];
  }
  file.array("patch", numbers);
  file.strings("surface", names);
  file.array("surface_id", as<std::int64_t>(mesh.surface));
  file.array("side", mesh.side);
  file.array("area", mesh.area, 1, "m^2");
}

void requireFields(const std::string& path, const PatchMesh& mesh,
                   std::span<const CellField> fields) {
  std::set<std::string> names = {"patch", "surface", "surface_id", "side", "area"};
  for (const CellField& field : fields) {
    if (field.components < 1 ||
        field.values.size() != mesh.size() * std::size_t(field.components)) {
      throw InputError(fmt::format(
          "{}: field {} has {} values of {} components for {} patches; give components, 1 or more, "
          "of every patch",
          path, field.name, field.values.size(), field.components, mesh.size()));
    }
    if (!names.insert(field.name).second) {
      throw InputError(fmt::format("{}: there are two fields {}; name one differently", path,
                                   field.name.empty() ? "without a name" : field.name));
    }
  }
}

}  // namespace

void writeVtp(const std::string& path, const PatchMesh& mesh, std::span<const CellField> fields) {
  requireFields(path, mesh, fields);
  VtpFile file(path);
  file.write(fmt::format(
      R"(<?xml version="1.0" encoding="UTF-8"?>
<VTKFile type="PolyData" version="1.0" byte_order="{}" header_type="UInt64">
<PolyData>
<FieldData>
)",
      std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian"));
  file.strings("surface_names", mesh.surface_names);
  file.write(fmt::format("</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfPolys=\"{}\">\n",
                         mesh.vertices.size(), mesh.size()));
  writeGeometry(file, mesh);
  file.write("<CellData>\n");
  writeIdentity(file, mesh);
  for (const CellField& field : fields) {
    file.array(field.name, field.values, field.components, field.unit);
  }
  file.write("</CellData>\n</Piece>\n</PolyData>\n</VTKFile>\n");
  file.commit();
}

}  // namespace radiosity
