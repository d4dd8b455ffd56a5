// A check of a Collada or X3D file before Assimp reads it, which follows nesting and references
// without a bound and does not get past words where numbers are due.
#pragma once

#include <pugixml.hpp>
#include <string>

namespace radiosity {

/// Errors: InputError "PATH: what is wrong; cure" for elements nested more than 200 deep,
/// references included; for an element that refers to itself; where references stand for more than
/// a million elements; for corners of Collada that are no numbers. Throws what readWholeFile()
/// throws. Returns the document; an empty one of what is no XML.
pugi::xml_document checkXml(const std::string& path);

}  // namespace radiosity
