// Light on surfaces, out of everything that holds some.
#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <numbers>

#include "base/srgb.h"
#include "radiosity/compare.h"

namespace radiosity {
namespace {

/// A byte of 255 may stand for anything above: its value is not known.
constexpr double kTopByte = 254.5 / 255;

Vec3 decoded(const Vec3& colour) {
  return {linearFromSrgb(colour.x), linearFromSrgb(colour.y), linearFromSrgb(colour.z)};
}

bool isConstant(const LightField& field) {
  std::vector<const Vec3*> first(field.cell_surface.size(), nullptr);
  for (std::size_t t = 0; t < field.triangles.size(); ++t) {
    const Vec3*& known = first[field.cell[t]];
    if (known == nullptr) known = &field.values[t][0];
    for (const Vec3& value : field.values[t]) {
      if (value != *known) return false;
    }
  }
  return true;
}

}  // namespace

LightField lightOf(const PatchMesh& mesh, std::span<const double> radiosity, std::string name,
                   std::span<const Vec3> emission) {
  if (radiosity.size() != 3 * mesh.size()) {
    throw InputError(fmt::format("{}: {} radiosities are given for {} patches", name,
                                 radiosity.size(), mesh.size()));
  }
  LightField field;
  field.name = std::move(name);
  field.vertices = mesh.vertices;
  field.surface_names = mesh.surface_names;
  field.cell_surface = mesh.surface;
  field.constant = true;
  for (const Vec3& e : emission) field.emits.push_back(e == Vec3(0.0) ? 0 : 1);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const Vec3 value(radiosity[3 * i], radiosity[3 * i + 1], radiosity[3 * i + 2]);
    for (std::size_t t = mesh.piece_offset[i]; t < mesh.piece_offset[i + 1]; ++t) {
      if (!(mesh.area[i] > 0)) continue;
      field.triangles.push_back(mesh.pieces[t]);
      field.values.push_back({value, value, value});
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
  field.values = mesh.colours;
  if (unit == LightUnit::srgb8) {
    field.relative = true;
    field.clipped.assign(mesh.triangles.size(), 0);
  }
  for (std::size_t t = 0; t < field.values.size(); ++t) {
    for (Vec3& value : field.values[t]) {
      if (unit == LightUnit::srgb8) {
        if (std::max({value.x, value.y, value.z}) >= kTopByte) field.clipped[t] = 1;
        value = decoded(value);
      } else if (unit == LightUnit::radiance) {
        value *= std::numbers::pi;
      }
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
