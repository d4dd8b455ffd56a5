#include "scene/inp/inp_bodies.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "base/lower_case.h"

namespace radiosity {

/// Shifts a point, then turns it about the axis (Rodrigues).
Vec3 InstancePlacement::of(const Vec3& place) const {
  const Vec3 shifted = place + shift;
  if (degrees == 0) return shifted;
  const Vec3 axis = glm::normalize(to - from);
  const Vec3 arm = shifted - from;
  const double angle = glm::radians(degrees);
  return from + std::cos(angle) * arm + std::sin(angle) * glm::cross(axis, arm) +
         (1 - std::cos(angle)) * glm::dot(axis, arm) * axis;
}

InpBodies::InpBodies(const InpPlace& at, std::deque<InpBody>& bodies)
    : at_(at), bodies_(bodies), body_(&bodies.emplace_back()) {}

void InpBodies::beginPart(const InpKeyword& keyword) {
  if (in_part_ || in_instance_) at_.fail("a part begins within another; end that with *END PART");
  const auto [place, is_new] = parts_.try_emplace(lowerCase(keyword.get("name")));
  if (!is_new) at_.fail(fmt::format("part `{}` is there twice; rename one", keyword.get("name")));
  in_part_ = true;
  body_ = &place->second;
}

void InpBodies::endPart() {
  in_part_ = false;
  body_ = &bodies_.front();
}

void InpBodies::beginInstance(const InpKeyword& keyword) {
  if (in_part_ || in_instance_) at_.fail("an instance begins within another; add *END INSTANCE");
  const std::string name = keyword.get("name");
  const auto part = parts_.find(lowerCase(keyword.get("part")));
  if (part == parts_.end()) {
    at_.fail(fmt::format("instance `{}` is of part `{}`, which does not come before it; correct it",
                         name, keyword.get("part")));
  }
  if (instanceNamed(lowerCase(name)) != nullptr) {
    at_.fail(fmt::format("instance `{}` is there twice; rename one", name));
  }
  body_ = &bodies_.emplace_back(part->second);
  body_->name = name;
  body_->set_index.clear();
  for (std::size_t s = 0; s < body_->sets.size(); ++s) {
    body_->sets[s].name = name + "." + body_->sets[s].name;
    body_->set_index[lowerCase(body_->sets[s].name)] = s;
  }
  for (InpSurface& surface : body_->surfaces) surface.name = name + "." + surface.name;
  in_instance_ = true;
  placements_.clear();
  placing_lines_ = 0;
}

void InpBodies::place(const std::vector<std::string_view>& fields) {
  const std::size_t expected = placing_lines_ == 0 ? 3 : 7;
  if (placing_lines_ > 1 || fields.size() != expected) {
    at_.fail(
        "an instance is placed by a line of 3 numbers, its shift, and one of 7, two points of an "
        "axis and degrees; correct it");
  }
  std::array<double, 7> values{};
  for (std::size_t k = 0; k < expected; ++k) values[k] = at_.coordinate(fields[k]);
  if (placing_lines_++ == 0) {
    placements_ = {{{values[0], values[1], values[2]}, Vec3(0.0), Vec3(0.0), 0}};
    return;
  }
  InstancePlacement& placement = placements_.front();
  placement.from = {values[0], values[1], values[2]};
  placement.to = {values[3], values[4], values[5]};
  placement.degrees = values[6];
  if (placement.degrees != 0 && placement.from == placement.to) {
    at_.fail("the two points of the axis are the same; correct them");
  }
}

void InpBodies::endInstance() {
  if (!in_instance_) at_.fail("*END INSTANCE ends none; correct it");
  for (const InstancePlacement& placement : placements_) {
    for (InpNode& node : body_->nodes) node.place = placement.of(node.place);
  }
  in_instance_ = false;
  body_ = &bodies_.front();
}

InpBody* InpBodies::instanceNamed(const std::string& name) const {
  for (std::size_t k = 1; k < bodies_.size(); ++k) {
    if (lowerCase(bodies_[k].name) == name) return &bodies_[k];
  }
  return nullptr;
}

std::string InpBodies::nameIn(const InpBody& body, const std::string& name) const {
  return in_instance_ ? body.name + "." + name : name;
}

}  // namespace radiosity
