// Where sheets of different planes touch or cross each other.
#pragma once

#include <vector>

#include "mesh/sheets.h"

namespace radiosity {

/// Finds the segments that sheets of different planes have in common and enters each as a contact
/// into the planes whose sheet it lies inside of. Its ends are points of `input`: existing ones
/// closer than coincidence, or new ones.
void addContacts(InputFaces& input, const std::vector<Plane>& planes,
                 const std::vector<Sheet>& sheets, EdgeTable& edges, Progress& progress);

}  // namespace radiosity
