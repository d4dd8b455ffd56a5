// Reports as dictionaries, by the names of their fields.
#pragma once

#include <pybind11/pybind11.h>

#include "radiosity/form_factors.h"
#include "radiosity/gather.h"
#include "radiosity/heat.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/solve.h"
#include "text.h"

namespace radiosity::python {

pybind11::list listOf(const std::vector<Note>& notes);
pybind11::dict dictOf(const MeshReport& report);
pybind11::dict dictOf(const FormFactorReport& report);
pybind11::dict dictOf(const SolveSummary& summary);
pybind11::dict dictOf(const GatherSummary& summary);
pybind11::dict dictOf(const HeatSummary& summary);
pybind11::dict dictOf(const SurfaceHeat& surface);

}  // namespace radiosity::python
