// All public headers: from a scene to form factors, a solution and a picture.
#pragma once

#include "radiosity/base.h"
#include "radiosity/closure.h"
#include "radiosity/compare.h"
#include "radiosity/exchange_matrix.h"
#include "radiosity/form_factors.h"
#include "radiosity/gather.h"
#include "radiosity/matrix_functions.h"
#include "radiosity/names.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/pipeline.h"
#include "radiosity/render.h"
#include "radiosity/results.h"
#include "radiosity/row_journal.h"
#include "radiosity/scene.h"
#include "radiosity/solve.h"
#include "radiosity/version.h"
