// Parts in the input of Abaqus, and their placed instances.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scene/inp/inp_keyword.h"
#include "scene/inp/inp_place.h"
#include "scene/inp/inp_scan.h"

namespace radiosity {

/// The place of an instance of a part.
struct InstancePlacement {
  Vec3 shift{0.0};
  Vec3 from{0.0};  ///< axis of the turn
  Vec3 to{0.0};
  double degrees = 0;

  Vec3 of(const Vec3& place) const;
};

/// The bodies of a scan; one of them is current.
class InpBodies {
 public:
  /// Both must outlive it; `bodies` gets the file's own.
  InpBodies(const InpPlace& at, std::deque<InpBody>& bodies);

  void beginPart(const InpKeyword& keyword);
  void endPart();
  void beginInstance(const InpKeyword& keyword);
  /// Reads the placement of an instance: the first line shifts it, the second turns it about an
  /// axis through two points.
  void place(const std::vector<std::string_view>& fields);
  void endInstance();

  /// Whether there are parts without instances, so that their place is unknown.
  bool hasPartsAlone() const { return !parts_.empty() && bodies_.size() == 1; }
  bool isInPart() const { return in_part_; }
  bool isInInstance() const { return in_instance_; }

  InpBody& current() const { return *body_; }
  std::deque<InpBody>& all() const { return bodies_; }
  /// The instance with this name in small letters, or null.
  InpBody* instanceNamed(const std::string& name) const;
  /// The name of a set of the body in lines that call it `name`: the lines of an instance leave out
  /// the instance.
  std::string nameIn(const InpBody& body, const std::string& name) const;

 private:
  const InpPlace& at_;
  std::deque<InpBody>& bodies_;
  InpBody* body_;                         ///< receives all that is read
  std::map<std::string, InpBody> parts_;  ///< by name in small letters
  bool in_part_ = false;
  bool in_instance_ = false;
  std::vector<InstancePlacement> placements_;  ///< of the current instance: none or one
  std::size_t placing_lines_ = 0;              ///< lines of its placement that were read
};

}  // namespace radiosity
