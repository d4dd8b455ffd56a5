// Reads input of CalculiX and Abaqus (Dhondt, "CalculiX CrunchiX User's Manual", keywords *NODE,
// *ELEMENT, *ELSET and *INCLUDE) line by line.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "radiosity/base.h"
#include "scene/grouped_faces.h"

namespace radiosity {

struct InpNode {
  long long number;
  Vec3 place;
  std::string where;  ///< "FILE:LINE", for errors
};

/// A shell or another element that is a face; or a volume.
struct InpElement {
  long long number;
  ElementShape shape;
  std::vector<long long> nodes;  ///< numbers of all its nodes
  std::string where;
};

/// Numbers first, first + step, ... up to last.
struct InpRange {
  long long first;
  long long last;
  long long step;
};

struct InpSet {
  std::string name;  ///< as it is first written; case does not count
  std::vector<InpRange> members;
  bool chosen = false;    ///< by *ELSET, not on the line *ELEMENT
  bool internal = false;  ///< a program's own, to make surfaces of: names nothing
};

/// A statement that makes elements of others, as *ELGEN.
struct InpMaker {
  std::string keyword;
  std::vector<InpRange> originals;
  std::string where;  ///< "FILE:LINE"
};

/// Some sides of elements, as *SURFACE lists them.
struct InpSides {
  std::vector<InpRange> elements;
  int side;  ///< from 1
};
struct InpSurface {
  std::string name;
  std::vector<InpSides> sides;
};

/// What has numbers of its own: what the file has outside of all parts, or an instance of a part,
/// moved to where it lies. Sets and surfaces of the part are called "INSTANCE.SET", as Abaqus does.
struct InpBody {
  std::string name;  ///< of the instance
  std::vector<InpNode> nodes;
  std::vector<InpElement> elements;
  std::vector<InpMaker> makers;                  ///< of elements
  std::vector<std::string> node_makers;          ///< keywords that make nodes, which are not there
  std::vector<InpSet> sets;                      ///< of elements, in the order they come
  std::map<std::string, std::size_t> set_index;  ///< by name in small letters
  std::vector<InpSurface> surfaces;              ///< of sides of volumes
};

struct InpScan {
  std::deque<InpBody> bodies;         ///< the file's own first
  std::vector<std::string> left_out;  ///< types of elements that are none of those asked for
  std::size_t volumes = 0;            ///< blocks of volumes among them
  std::vector<Note> notes;
  bool hasElements() const;
  bool hasNodes() const;
};

enum class InpElements { faces, volumes };

/// Reads the file and those that it includes: elements of one kind. Errors: InputError "FILE:LINE:
/// what is wrong; cure".
InpScan scanInp(const std::string& path, InpElements kind);

}  // namespace radiosity
