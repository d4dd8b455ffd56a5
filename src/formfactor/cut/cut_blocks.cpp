#include "formfactor/cut/cut_blocks.h"

#include <algorithm>
#include <utility>

namespace radiosity {
CutBlocks::CutBlocks(const RowCutter& cutter, std::uint32_t rays, const Progress& progress)
    : cutter_(cutter),
      rays_(rays),
      progress_(progress),
      rows_(CutParts::blocksOf(cutter.tree().patches().size())),
      counts_(cutter.tree().patches().size()) {}

std::size_t CutBlocks::steps(std::size_t block) const {
  return std::min(CutParts::kBlock, counts_.size() - block * CutParts::kBlock);
}

void CutBlocks::make(std::size_t block) {
  CutRows rows;
  for (std::size_t r = 0; r < steps(block); ++r) {
    const std::size_t place = block * CutParts::kBlock + r;
    RayRow row;
    cutter_.scene().cast(cutter_.positionOf(place), rays_, row, progress_);
    if (progress_.cancelled()) return;
    counts_[place] = cutter_.cut(place, row, rows);
  }
  // Blocks stay: grown vectors are a third larger than what is in them.
  rows.nodes.shrink_to_fit();
  rows.hits.shrink_to_fit();
  rows.places.shrink_to_fit();
  rows_[block] = std::move(rows);
}

void CutBlocks::put(std::size_t block, ByteWriter& bytes) const {
  const CutRows& rows = rows_[block];
  bytes.put(rays_);
  bytes.putArray(std::span(rows.ends));
  bytes.putArray(std::span(rows.nodes));
  bytes.putArray(std::span(rows.hits));
  bytes.putArray(std::span(rows.places));
  for (std::size_t r = 0; r < steps(block); ++r) {
    const CutCounts& counts = counts_[block * CutParts::kBlock + r];
    bytes.put(counts.rays);
    bytes.put(counts.sky);
    bytes.put(counts.known);
    bytes.putArray(std::span(counts.backs));
  }
}

bool CutBlocks::take(std::size_t block, ByteReader& bytes) {
  if (bytes.get<std::uint32_t>() != rays_) return false;
  CutRows rows;
  rows.ends = bytes.getArray<std::uint32_t>();
  rows.nodes = bytes.getArray<Index>();
  rows.hits = bytes.getArray<CutRows::Hits>();
  rows.places = bytes.getArray<CutRows::Place>();
  std::vector<CutCounts> counts(steps(block));
  for (CutCounts& of : counts) {
    of.rays = bytes.get<double>();
    of.sky = bytes.get<double>();
    of.known = bytes.get<double>();
    of.backs = bytes.getArray<SeenBack>();
  }
  if (!rows.isOf(counts.size(), cutter_.tree().nodes().size())) return false;
  rows_[block] = std::move(rows);
  std::ranges::move(counts, counts_.begin() + std::ptrdiff_t(block * CutParts::kBlock));
  return true;
}

void CutBlocks::tell(BlockRange range, ByteWriter& bytes) {
  for (std::size_t block = range.begin; block < range.end; ++block) {
    put(block, bytes);
    rows_[block] = {};
  }
}

bool CutBlocks::hear(BlockRange range, ByteReader& bytes) {
  bool heard = true;
  for (std::size_t block = range.begin; block < range.end; ++block) {
    heard = take(block, bytes) && heard;
  }
  return heard;
}

}  // namespace radiosity
