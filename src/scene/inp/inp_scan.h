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

/// An element that is a face, such as a shell, or a volume.
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
  std::string name;  ///< in its first spelling; case does not matter
  std::vector<InpRange> members;
  bool chosen = false;    ///< by *ELSET, not on the line *ELEMENT
  bool internal = false;  ///< made by a program for surfaces: its name is not used
};

/// A statement that makes elements from others, such as *ELGEN.
struct InpMaker {
  std::string keyword;
  std::vector<InpRange> originals;
  std::string where;  ///< "FILE:LINE"
};

/// Sides of elements in a *SURFACE.
struct InpSides {
  /// Of shells: the side to which the normal points, and the other.
  static constexpr int kPositive = 7;
  static constexpr int kNegative = 8;
  std::vector<InpRange> elements;
  int side;  ///< of a volume, from 1 to 6; or of a shell
};
struct InpSurface {
  std::string name;
  std::vector<InpSides> sides;
};

/// A body with its own numbering: the contents of the file outside of parts, or an instance of a
/// part, moved to its place. Sets and surfaces of a part are called "INSTANCE.SET", as in Abaqus.
struct InpBody {
  std::string name;  ///< of the instance
  std::vector<InpNode> nodes;
  std::vector<InpElement> elements;
  std::vector<InpMaker> makers;                  ///< of elements
  std::vector<std::string> node_makers;          ///< keywords that make nodes, which we do not
  std::vector<InpSet> sets;                      ///< of elements, in the order they come
  std::map<std::string, std::size_t> set_index;  ///< by name in small letters
  std::vector<InpSurface> surfaces;              ///< of sides of volumes and shells
};

struct InpScan {
  std::deque<InpBody> bodies;         ///< the file's own first
  std::vector<std::string> left_out;  ///< types of elements that were not asked for
  std::size_t volumes = 0;            ///< blocks of volumes among them
  std::vector<Note> notes;
  bool hasElements() const;
  bool hasNodes() const;
};

enum class InpElements { faces, volumes };

/// Reads the elements of one kind in the file and in those that it includes. Errors: InputError
/// "FILE:LINE: what is wrong; cure".
InpScan scanInp(const std::string& path, InpElements kind);

}  // namespace radiosity
