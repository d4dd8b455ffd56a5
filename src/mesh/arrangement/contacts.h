// Finds contacts: segments where sheets of different planes touch or cross.
#pragma once

#include <vector>

#include "mesh/faces/sheets.h"

namespace radiosity {

/// Finds the segments that sheets of different planes have in common. Enters each as a contact into
/// every plane with a sheet that contains it. Its ends are points of `input`: existing ones closer
/// than coincidence, or new ones.
void addContacts(InputFaces& input, const std::vector<Plane>& planes,
                 const std::vector<Sheet>& sheets, EdgeTable& edges, Progress& progress);

}  // namespace radiosity
