// Checks a Collada file before Assimp reads it: Assimp follows nesting and references
// without a limit, and loops at words in place of numbers.
#pragma once

#include <pugixml.hpp>
#include <string>

namespace radiosity {

/// Returns the document; an empty one if the file is not XML. Errors: those of readWholeFile(), and
/// InputError "PATH: what is wrong; cure" for elements nested more than 200 deep, references
/// included; for an element that refers to itself; if references stand for more than a million
/// elements; and for corners that are not numbers.
pugi::xml_document checkXml(const std::string& path);

}  // namespace radiosity
