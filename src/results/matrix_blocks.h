// The form-factor matrix in a results file: compressed sparse rows for scipy's csr_matrix((data,
// indices, indptr), shape), written and read block by block.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "matrix/dealt_blocks.h"
#include "radiosity/exchange_matrix.h"
#include "radiosity/scratch_memory.h"
#include "results/h5_reader.h"
#include "results/h5_writer.h"

namespace radiosity {

/// Writes area, shape (int64), indptr (int64), indices (int32, increasing in a row), data (f32 or
/// f64 as stored) and row_sum (of the stored values). A symmetric matrix also has order (uint32,
/// the order in which it stores patches), which marks it as symmetric. Holds one chunk of each at a
/// time, and for a symmetric matrix a panel of rows. Rows that are cut have area and the groups cut
/// (cut_rows.h) and, of what is known pair by pair, cut/pairs.
void writeMatrix(h5::OutputGroup& group, const ExchangeOperator& matrix, Progress& progress);

/// Writes the blocks of a matrix whose rows lie in several processes, each into its place in the
/// file that process 0 is writing. `job`: from writeMatrix() in process 0.
std::unique_ptr<BlockTaker> makeMatrixBlockWriter(std::span<const std::byte> job);

/// Counts the bytes that writeMatrix() adds to the file.
void countMatrix(h5::SizeCounter& group, const ExchangeOperator& matrix);

/// A part of the rows of a matrix. There is one part for each process, with about equal numbers of
/// entries.
struct MatrixPart {
  std::size_t part = 0;
  std::size_t parts = 1;
};

/// Reads the matrix, to the bit. `scratch`: the memory for it; null: ordinary memory. `part`: the
/// rows to read; all others are empty.
std::shared_ptr<const ExchangeOperator> readMatrix(const h5::InputGroup& group,
                                                   std::shared_ptr<ScratchMemory> scratch);

/// Reads rows of the matrix in the results file `path`, which must have one. Errors: as
/// readResults().
std::shared_ptr<const ExchangeMatrix> readMatrixPart(const std::string& path,
                                                     const MatrixPart& part);

}  // namespace radiosity
