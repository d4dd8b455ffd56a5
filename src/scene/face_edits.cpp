#include "scene/face_edits.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "base/geometry/plane_frame.h"
#include "radiosity/spelling.h"
#include "scene/text.h"

namespace radiosity {

namespace {

/// Turns one face's values over; its first corner stays the first.
template <class T>
void turn(std::vector<T>& values, std::size_t begin, std::size_t end) {
  if (values.empty() || begin == end) return;
  std::reverse(values.begin() + std::ptrdiff_t(begin) + 1, values.begin() + std::ptrdiff_t(end));
}

}  // namespace

FaceEdits::FaceEdits(Scene& scene)
    : scene_(scene), flipped_(scene.surfaces.size(), 0), left_out_(scene.surfaces.size(), 0) {}

void FaceEdits::flip(const std::string& name, std::span<const Index> surfaces) {
  for (const Index s : surfaces) flipped_[s] = 1;
  edits_.push_back({What::flip, name, {surfaces.begin(), surfaces.end()}});
}

void FaceEdits::leaveOut(const std::string& name, std::span<const Index> surfaces) {
  for (const Index s : surfaces) left_out_[s] = 1;
  edits_.push_back({What::leave_out, name, {surfaces.begin(), surfaces.end()}});
}

void FaceEdits::requireFaces() const {
  const bool any = std::ranges::any_of(scene_.face_surface,
                                       [this](Index surface) { return left_out_[surface] == 0; });
  if (any || scene_.faceCount() == 0) return;
  throw InputError(spelled("without", edits_.back().name) + ": leaves no face; keep a surface");
}

std::vector<double> FaceEdits::areas() const {
  std::vector<double> areas(scene_.surfaces.size(), 0.0);
  for (std::size_t f = 0; f < scene_.faceCount(); ++f) {
    const auto face = scene_.face(f);
    areas[scene_.face_surface[f]] += glm::length(vectorArea(
        face.size(), [&](std::size_t k) -> const Vec3& { return scene_.vertices[face[k]]; }));
  }
  return areas;
}

void FaceEdits::apply() {
  if (edits_.empty()) return;
  const std::vector<double> areas = this->areas();
  std::vector<std::size_t> faces(scene_.surfaces.size(), 0);
  for (const Index surface : scene_.face_surface) ++faces[surface];
  for (const Edit& edit : edits_) note(edit, areas, faces);
  turnFaces();
  if (std::ranges::none_of(left_out_, [](std::uint8_t out) { return out != 0; })) return;
  dropFaces();
  dropSurfaces();
}

void FaceEdits::note(const Edit& edit, std::span<const double> areas,
                     std::span<const std::size_t> faces) const {
  double area = 0;
  std::size_t count = 0;
  std::vector<std::string> names;
  for (const Index s : edit.surfaces) {
    area += areas[s];
    count += faces[s];
    names.push_back(scene_.surfaces[s].name);
  }
  const bool literal = names.size() == 1 && names[0] == edit.name;
  scene_.notes.push_back(
      {Severity::info, fmt::format("{}{}: {} face{}, {:.6g} m^2, {}", edit.name,
                                   literal ? "" : fmt::format(" ({})", joinNames(names)), count,
                                   count == 1 ? "" : "s", area,
                                   edit.what == What::flip ? "turned over" : "left out")});
}

void FaceEdits::turnFaces() {
  for (std::size_t f = 0; f < scene_.faceCount(); ++f) {
    if (flipped_[scene_.face_surface[f]] == 0) continue;
    const std::size_t begin = scene_.face_offset[f];
    const std::size_t end = scene_.face_offset[f + 1];
    turn(scene_.corners, begin, end);
    turn(scene_.texcoords, begin, end);
    turn(scene_.colours, begin, end);
  }
}

/// Moves the faces that stay down to the places of those that do not.
void FaceEdits::dropFaces() {
  std::size_t faces = 0;
  std::size_t corners = 0;
  const auto move = [&corners](auto& values, std::size_t begin, std::size_t end) {
    if (values.empty()) return;
    std::copy(values.begin() + std::ptrdiff_t(begin), values.begin() + std::ptrdiff_t(end),
              values.begin() + std::ptrdiff_t(corners));
  };
  for (std::size_t f = 0; f < scene_.faceCount(); ++f) {
    if (left_out_[scene_.face_surface[f]] != 0) continue;
    const std::size_t begin = scene_.face_offset[f];
    const std::size_t end = scene_.face_offset[f + 1];
    move(scene_.corners, begin, end);
    move(scene_.texcoords, begin, end);
    move(scene_.colours, begin, end);
    scene_.face_surface[faces] = scene_.face_surface[f];
    scene_.face_element[faces] = scene_.face_element[f];
    corners += end - begin;
    scene_.face_offset[++faces] = corners;
  }
  scene_.face_offset.resize(faces + 1);
  scene_.face_surface.resize(faces);
  scene_.face_element.resize(faces);
  scene_.corners.resize(corners);
  if (!scene_.texcoords.empty()) scene_.texcoords.resize(corners);
  if (!scene_.colours.empty()) scene_.colours.resize(corners);
}

void FaceEdits::dropSurfaces() {
  std::vector<Index> number(scene_.surfaces.size(), kNone);
  std::vector<Surface> kept;
  for (std::size_t s = 0; s < scene_.surfaces.size(); ++s) {
    if (left_out_[s] != 0) continue;
    number[s] = Index(kept.size());
    kept.push_back(std::move(scene_.surfaces[s]));
  }
  scene_.surfaces = std::move(kept);
  for (Index& surface : scene_.face_surface) surface = number[surface];
}

}  // namespace radiosity
