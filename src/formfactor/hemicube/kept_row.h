// A row of hemicubes in a journal.
#pragma once

#include <cstddef>
#include <vector>

#include "formfactor/hemicube/hemicube.h"
#include "formfactor/row_accounts.h"
#include "radiosity/form_factors.h"
#include "radiosity/row_journal.h"
#include "radiosity/row_matrix.h"

namespace radiosity {

/// Keeps row i, which has been stored, its black backs and counts, as a block.
void keepRow(RowJournal& journal, std::size_t i, const RowMatrix& matrix, const FormFactors& result,
             const std::vector<SeenBack>& seen_backs, const HemicubeReport& counts);

/// Puts a row where it was, and adds its counts. False if the journal has no such row: then nothing
/// has changed. Thread-safe for different rows and counts.
bool takeRow(const RowJournal& journal, std::size_t i, RowMatrix& matrix, FormFactors& result,
             std::vector<SeenBack>& seen_backs, HemicubeReport& counts);

}  // namespace radiosity
