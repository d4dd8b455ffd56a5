// The form-factor matrix in a results file: compressed sparse rows, as scipy's
// csr_matrix((data, indices, indptr), shape) takes them, moved block by block.
#pragma once

#include "radiosity/exchange_matrix.h"
#include "results/h5_reader.h"
#include "results/h5_writer.h"

namespace radiosity {

/// Writes area, shape (int64), indptr (int64), indices (int32, increasing in a row), data (f32 or
/// f64 as stored) and row_sum (of what is stored); of a symmetric matrix also order (uint32, the
/// patches as it stores them), which marks it as symmetric. Holds one chunk of each at a time, and
/// of a symmetric matrix a panel of rows.
void writeMatrix(h5::OutputGroup& group, const ExchangeMatrix& matrix, Progress& progress);

/// Counts the bytes that writeMatrix() adds to the file.
void countMatrix(h5::SizeCounter& group, const ExchangeMatrix& matrix);

/// Rows of a matrix, as many parts of about equal numbers of entries as processes.
struct MatrixPart {
  std::size_t part = 0;
  std::size_t parts = 1;
};

/// The same matrix, value for value to the bit. `scratch`: where it is to be; null: in memory.
/// `part`: the rows to read; all others are empty.
ExchangeMatrix readMatrix(const h5::InputGroup& group, std::shared_ptr<ScratchMemory> scratch,
                          const MatrixPart& part = {});

/// Rows of the matrix in the results file `path`, which has one. Errors: as readResults().
ExchangeMatrix readMatrixPart(const std::string& path, const MatrixPart& part);

}  // namespace radiosity
