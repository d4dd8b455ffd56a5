#include "scene/inp/inp_sets.h"

#include <fmt/format.h>

#include <optional>

#include "base/lower_case.h"
#include "base/parse.h"

namespace radiosity {

namespace {

/// The most members of sets: nested sets that no person means are refused before they fill memory.
constexpr std::size_t kMostMembers = std::size_t(1) << 24U;

/// The number of the set with this name, which is created if it does not exist.
std::size_t setIn(InpBody& body, const std::string& name) {
  const auto [place, is_new] = body.set_index.try_emplace(lowerCase(name), body.sets.size());
  if (is_new) body.sets.push_back({name, {}});
  return place->second;
}

}  // namespace

void InpSets::beginIn(InpBody& body, const std::string& name) {
  body_ = &body;
  set_ = setIn(body, bodies_.nameIn(body, name));
}

void InpSets::begin(const InpKeyword& keyword) {
  if (keyword.get("elset").empty()) at_.fail("*ELSET names no set; add ELSET=NAME");
  InpBody* body = &bodies_.current();
  if (keyword.has("instance")) {
    const std::string instance = keyword.get("instance");
    body = bodies_.instanceNamed(lowerCase(instance));
    if (body == nullptr) {
      at_.fail(fmt::format("there is no instance `{}` before it; correct it", instance));
    }
  }
  beginIn(*body, keyword.get("elset"));
  body_->sets[set_].chosen = true;
  if (keyword.has("internal")) body_->sets[set_].internal = true;
}

void InpSets::addElement(long long number) { addMember(body_->sets[set_], {number, number, 1}); }

void InpSets::addMembers(const std::vector<std::string_view>& fields) {
  for (const std::string_view field : fields) {
    if (const std::optional<long long> number = parseInteger(field)) {
      addElement(*number);
      continue;
    }
    addMembersNamed(field);
  }
}

/// Adds the members of a set. Sets of the assembly may also have "INSTANCE.12" and "INSTANCE.SET",
/// which go to a set of that instance.
void InpSets::addMembersNamed(std::string_view field) {
  const std::string name = lowerCase(field);
  const std::size_t dot = name.find('.');
  InpBody* body = dot == std::string::npos ? nullptr : bodies_.instanceNamed(name.substr(0, dot));
  std::size_t set = set_;
  if (body == nullptr) {
    body = body_;
  } else if (body != body_) {
    const InpSet& listed = body_->sets[set_];
    set = setIn(*body, listed.name);
    body->sets[set].chosen = listed.chosen;
    body->sets[set].internal = listed.internal;
  }
  if (const auto number = parseInteger(std::string_view(name).substr(dot + 1));
      number && dot != std::string::npos) {
    return addMember(body->sets[set], {*number, *number, 1});
  }
  auto found = body->set_index.find(name);
  if (found == body->set_index.end())
    found = body->set_index.find(lowerCase(bodies_.nameIn(bodies_.current(), name)));
  if (found == body->set_index.end()) {
    at_.fail(
        fmt::format("`{}` is neither an element nor a set that came before; correct it", field));
  }
  if (found->second == set) return;
  for (const InpRange& range : body->sets[found->second].members) {
    addMember(body->sets[set], range);
  }
}

void InpSets::addRange(const std::vector<std::string_view>& fields) {
  if (fields.size() < 2 || fields.size() > 3) {
    at_.fail(fmt::format("GENERATE takes first, last and step, not {} numbers; correct the line",
                         fields.size()));
  }
  const InpRange range{at_.integer(fields[0], "first element"),
                       at_.integer(fields[1], "last element"),
                       fields.size() > 2 ? at_.integer(fields[2], "step") : 1};
  if (range.step <= 0 || range.last < range.first) {
    at_.fail(
        "the last element is not less than the first, and the step is 1 or more; correct the line");
  }
  addMember(body_->sets[set_], range);
}

void InpSets::addMember(InpSet& set, const InpRange& range) {
  if (++member_count_ > kMostMembers) {
    at_.fail(
        fmt::format("its element sets have more than {} members; write them without one another",
                    kMostMembers));
  }
  set.members.push_back(range);
}

}  // namespace radiosity
