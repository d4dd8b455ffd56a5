// Triangles that lie so close to others that single precision cannot tell which comes first.
#pragma once

#include <cstdint>
#include <vector>

#include "formfactor/view_triangles.h"

namespace radiosity {

/// For each triangle whether it covers part of one of another polygon, nearly parallel and a few
/// roundings of single precision away: a lamp a hair before its ceiling, both faces of a thin
/// plate, a box that rests on its floor but for noise. Nothing if no triangle is.
std::vector<std::uint8_t> nearTriangles(const ViewScene& scene, const ViewTriangles& triangles);

}  // namespace radiosity
