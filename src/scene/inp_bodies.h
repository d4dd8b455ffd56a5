// Parts of input of Abaqus, and the instances that are placed of them.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scene/inp_keyword.h"
#include "scene/inp_place.h"
#include "scene/inp_scan.h"

namespace radiosity {

/// Where an instance of a part lies.
struct InstancePlacement {
  Vec3 shift{0.0};
  Vec3 from{0.0};  ///< axis of the turn
  Vec3 to{0.0};
  double degrees = 0;

  Vec3 of(const Vec3& place) const;
};

/// The bodies of a scan, and the one that things are added to.
class InpBodies {
 public:
  /// Both are kept by reference; `bodies` gets the file's own.
  InpBodies(const InpPlace& at, std::deque<InpBody>& bodies);

  void beginPart(const InpKeyword& keyword);
  void endPart();
  void beginInstance(const InpKeyword& keyword);
  /// The first line shifts an instance, the second turns it about an axis of two points.
  void place(const std::vector<std::string_view>& fields);
  void endInstance();

  /// Nothing says where they lie.
  bool hasPartsAlone() const { return !parts_.empty() && bodies_.size() == 1; }
  bool isInPart() const { return in_part_; }
  bool isInInstance() const { return in_instance_; }

  InpBody& current() const { return *body_; }
  std::deque<InpBody>& all() const { return bodies_; }
  /// The instance of that name in small letters, or null.
  InpBody* instanceNamed(const std::string& name) const;
  /// As a set of the body is called where lines say `name`: an instance's own lines leave out the
  /// instance.
  std::string nameIn(const InpBody& body, const std::string& name) const;

 private:
  const InpPlace& at_;
  std::deque<InpBody>& bodies_;
  InpBody* body_;                         ///< the current one
  std::map<std::string, InpBody> parts_;  ///< by name in small letters
  bool in_part_ = false;
  bool in_instance_ = false;
  std::vector<InstancePlacement> placements_;  ///< of the instance at hand: none or one
  std::size_t placing_lines_ = 0;              ///< of its data, read
};

}  // namespace radiosity
