// Rows that are cut through a tree, in a results file: the group cut of the form factors.
#pragma once

#include <memory>
#include <vector>

#include "matrix/cut_operator.h"
#include "results/h5_reader.h"
#include "results/h5_writer.h"

namespace radiosity {

inline constexpr const char* kCutGroup = "cut";
inline constexpr const char* kPairsGroup = "pairs";

/// Writes order (uint32, the unknown at each place in the tree), features (f32, six columns: place
/// and normal at each place), counts and of_a_hit (f64), starts (int64, of each place's entries,
/// and the end), nodes (uint32), hits (uint32, those of the second set of rays 16 bits up), places
/// (uint8, six an entry in two's complement), the attribute bias and, in the group pairs, what is
/// known pair by pair. The tree halves its patches by number, so that its nodes follow from the
/// order.
void writeCut(h5::OutputGroup& group, const CutOperator& factors, Progress& progress);

/// Counts the bytes that writeCut() adds to the file.
void countCut(h5::SizeCounter& group, const CutOperator& factors);

/// Reads the same, but pairs; all is checked.
CutParts readCut(const h5::InputGroup& group, std::vector<double> area);

}  // namespace radiosity
