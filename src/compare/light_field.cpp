// Makes light fields from solutions and from lit meshes.
#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>

#include "base/srgb.h"
#include "radiosity/compare.h"

namespace radiosity {
namespace {

Vec3 decoded(const Vec3& colour) {
  return {linearFromSrgb(colour.x), linearFromSrgb(colour.y), linearFromSrgb(colour.z)};
}

bool isConstant(const LightField& field) {
  const auto bands = std::size_t(field.bands);
  std::vector<const double*> first(field.cell_surface.size(), nullptr);
  for (std::size_t t = 0; t < field.triangles.size(); ++t) {
    const double* values = field.values.data() + 3 * bands * t;
    const double*& known = first[field.cell[t]];
    if (known == nullptr) known = values;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      if (!std::equal(known, known + bands, values + bands * corner)) return false;
    }
  }
  return true;
}

void requireSizes(const PatchMesh& mesh, std::span<const double> radiosity, int bands,
                  const std::string& name, std::span<const double> emission) {
  const std::size_t needed = mesh.size() * std::size_t(std::max(bands, 1));
  const auto check = [&](const char* what, std::size_t size) {
    if (bands >= 1 && size == needed) return;
    throw InputError(
        fmt::format("{}: {} {} are given for {} patches of {} bands; give {}, a row of "
                    "all bands for each patch",
                    name, size, what, mesh.size(), bands, needed));
  };
  check("radiosities", radiosity.size());
  if (!emission.empty()) check("emissions", emission.size());
}

}  // namespace

LightField lightOf(const PatchMesh& mesh, std::span<const double> radiosity, int bands,
                   std::string name, std::span<const double> emission) {
  requireSizes(mesh, radiosity, bands, name, emission);
  const auto width = std::size_t(bands);
  LightField field;
  field.name = std::move(name);
  field.vertices = mesh.vertices;
  field.surface_names = mesh.surface_names;
  field.cell_surface = mesh.surface;
  field.bands = bands;
  field.constant = true;
  for (std::size_t i = 0; i < emission.size() / width; ++i) {
    const std::span<const double> row = emission.subspan(width * i, width);
    field.emits.push_back(std::any_of(row.begin(), row.end(), [](double e) { return e != 0; }));
  }
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const std::span<const double> row = radiosity.subspan(width * i, width);
    for (std::size_t t = mesh.piece_offset[i]; t < mesh.piece_offset[i + 1]; ++t) {
      if (!(mesh.area[i] > 0)) continue;
      field.triangles.push_back(mesh.pieces[t]);
      for (int corner = 0; corner < 3; ++corner) {
        field.values.insert(field.values.end(), row.begin(), row.end());
      }
      field.cell.push_back(Index(i));
    }
  }
  return field;
}

LightField lightOf(const LitMesh& mesh, LightUnit unit) {
  LightField field;
  field.name = mesh.file;
  field.vertices = mesh.vertices;
  field.triangles = mesh.triangles;
  field.cell = mesh.face;
  field.cell_surface = mesh.face_surface;
  field.surface_names = mesh.surface_names;
  if (unit == LightUnit::srgb8) {
    field.relative = true;
    field.clipped.assign(mesh.triangles.size(), 0);
  }
  for (std::size_t t = 0; t < mesh.colours.size(); ++t) {
    for (Vec3 value : mesh.colours[t]) {
      if (unit == LightUnit::srgb8) {
        if (std::max({value.x, value.y, value.z}) >= kBrightestByte) field.clipped[t] = 1;
        value = decoded(value);
      } else if (unit == LightUnit::radiance) {
        value *= std::numbers::pi;
      }
      field.values.insert(field.values.end(), {value.x, value.y, value.z});
    }
  }
  field.constant = isConstant(field);
  return field;
}

PatchMesh cellMesh(const LightField& side) {
  PatchMesh mesh;
  mesh.vertices = side.vertices;
  mesh.surface_names = side.surface_names;
  mesh.corner_offset = mesh.piece_offset = {0};
  for (std::size_t t = 0; t < side.triangles.size(); ++t) {
    const std::array<Index, 3>& corners = side.triangles[t];
    const Vec3& a = side.vertices[corners[0]];
    const Vec3& b = side.vertices[corners[1]];
    const Vec3& c = side.vertices[corners[2]];
    const Vec3 cross = glm::cross(b - a, c - a);
    const double length = glm::length(cross);
    mesh.corners.insert(mesh.corners.end(), corners.begin(), corners.end());
    mesh.corner_offset.push_back(mesh.corners.size());
    mesh.pieces.push_back(corners);
    mesh.piece_offset.push_back(mesh.pieces.size());
    mesh.centroid.push_back((a + b + c) / 3.0);
    mesh.normal.push_back(length > 0 ? cross / length : Vec3(0.0));
    mesh.area.push_back(0.5 * length);
    mesh.polygon.push_back(Index(t));
    mesh.surface.push_back(side.cell_surface[side.cell[t]]);
    mesh.index_in_surface.push_back(Index(t));
    mesh.source_face.push_back(side.cell[t]);
    mesh.side.push_back(0);
    mesh.twin.push_back(kNone);
  }
  return mesh;
}

std::vector<double> differenceOnTriangles(const LightField& side, const Comparison& comparison) {
  std::vector<double> values;
  for (const Index cell : side.cell) {
    const double difference = comparison.difference[cell];
    values.push_back(std::isnan(difference) ? 0 : difference);
  }
  return values;
}

}  // namespace radiosity
