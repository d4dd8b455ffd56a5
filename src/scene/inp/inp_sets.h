// Reads sets of elements in the input of CalculiX and Abaqus.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "scene/inp/inp_bodies.h"

namespace radiosity {

/// Adds members to the current set.
class InpSets {
 public:
  InpSets(const InpPlace& at, InpBodies& bodies) : at_(at), bodies_(bodies) {}

  /// Reads *ELSET. A set of the assembly belongs to the instance whose elements it lists.
  void begin(const InpKeyword& keyword);
  /// Begins a set of a body.
  void beginIn(InpBody& body, const std::string& name);

  void addElement(long long number);
  /// Reads a line of numbers and names.
  void addMembers(const std::vector<std::string_view>& fields);
  /// Reads a line of GENERATE.
  void addRange(const std::vector<std::string_view>& fields);

 private:
  void addMembersNamed(std::string_view field);
  void addMember(InpSet& set, const InpRange& range);

  const InpPlace& at_;
  InpBodies& bodies_;
  InpBody* body_ = nullptr;  ///< the body of set_
  std::size_t set_ = 0;
  std::size_t member_count_ = 0;
};

}  // namespace radiosity
