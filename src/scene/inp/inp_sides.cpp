#include "scene/inp/inp_sides.h"

#include <optional>

#include "base/lower_case.h"
#include "base/parse.h"

namespace radiosity {

namespace {

/// `members`: a set or an element of the body; "INSTANCE.12" if the body is an instance.
void addSidesTo(InpBody& body, const InpBodies& bodies, std::string_view members, int side) {
  InpSides sides{{}, side};
  const std::string name = lowerCase(members);
  const std::string prefix = lowerCase(body.name) + ".";
  const bool is_element = !body.name.empty() && name.starts_with(prefix);
  const bool is_local = body.name.empty() || bodies.isInInstance();
  const std::optional<long long> number =
      parseInteger(is_element ? std::string_view(name).substr(prefix.size()) : members);
  if (number && (is_element || is_local)) {
    sides.elements.push_back({*number, *number, 1});
  } else if (const auto found =
                 body.set_index.find(lowerCase(bodies.nameIn(bodies.current(), name)));
             found != body.set_index.end()) {
    sides.elements = body.sets[found->second].members;
  }
  if (!sides.elements.empty()) body.surfaces.back().sides.push_back(std::move(sides));
}

/// 0: it is no side.
int sideCalled(const std::string& label) {
  if (label.empty() || label == "spos") return InpSides::kPositive;
  if (label == "sneg") return InpSides::kNegative;
  const bool of_volume = label.size() == 2 && label[0] == 's' && label[1] >= '1' && label[1] <= '6';
  return of_volume ? label[1] - '0' : 0;
}

}  // namespace

void beginSurface(InpBodies& bodies, const std::string& name) {
  const std::string own = bodies.isInInstance() ? bodies.current().name + "." : "";
  const auto begin = [&](InpBody& body) { body.surfaces.push_back({own + name, {}}); };
  if (bodies.isInPart() || bodies.isInInstance()) {
    begin(bodies.current());
  } else {
    for (InpBody& body : bodies.all()) begin(body);
  }
}

void addSides(InpBodies& bodies, const std::vector<std::string_view>& fields) {
  if (fields.empty() || fields.size() > 2) return;
  const int side = sideCalled(fields.size() == 2 ? lowerCase(fields[1]) : "");
  if (side == 0) return;
  if (bodies.isInPart() || bodies.isInInstance()) {
    return addSidesTo(bodies.current(), bodies, fields[0], side);
  }
  for (InpBody& body : bodies.all()) addSidesTo(body, bodies, fields[0], side);
}

}  // namespace radiosity
