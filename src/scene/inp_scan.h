// Reads input of CalculiX and Abaqus (Dhondt, "CalculiX CrunchiX User's Manual", keywords *NODE,
// *ELEMENT, *ELSET and *INCLUDE) line by line.
#pragma once

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
  bool chosen = false;  ///< by *ELSET, not on the line *ELEMENT
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

struct InpScan {
  std::vector<InpNode> nodes;
  std::vector<InpElement> elements;
  std::vector<std::string> left_out;     ///< types of elements that are none of those asked for
  std::size_t volumes = 0;               ///< blocks of volumes among them
  std::vector<InpMaker> makers;          ///< of elements
  std::vector<std::string> node_makers;  ///< keywords that make nodes, which are not there
  std::vector<InpSet> sets;              ///< of elements, in the order they come
  std::vector<InpSurface> surfaces;      ///< of sides of volumes
  std::vector<Note> notes;
};

enum class InpElements { faces, volumes };

/// Reads the file and those that it includes: elements of one kind. Errors: InputError "FILE:LINE:
/// what is wrong; cure".
InpScan scanInp(const std::string& path, InpElements kind);

}  // namespace radiosity
