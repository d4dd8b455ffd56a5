// Sets of elements as lines of CalculiX's and Abaqus' input list them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "scene/inp_bodies.h"

namespace radiosity {

/// The set that members are added to.
class InpSets {
 public:
  InpSets(const InpPlace& at, InpBodies& bodies) : at_(at), bodies_(bodies) {}

  /// *ELSET. A set of the assembly is one of the instance whose elements it lists.
  void begin(const InpKeyword& keyword);
  /// A set of that name of a body.
  void beginIn(InpBody& body, const std::string& name);

  void addElement(long long number);
  /// A line of numbers and names.
  void addMembers(const std::vector<std::string_view>& fields);
  /// A line of GENERATE.
  void addRange(const std::vector<std::string_view>& fields);

 private:
  void addMembersNamed(std::string_view field);
  void addMember(InpSet& set, const InpRange& range);

  const InpPlace& at_;
  InpBodies& bodies_;
  InpBody* body_ = nullptr;  ///< that set_ is of
  std::size_t set_ = 0;
  std::size_t member_count_ = 0;
};

}  // namespace radiosity
