#include "matrix/dealt_blocks.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace radiosity {

void DealtBlocks::send(Processes& processes, const WhileWaiting& waiting) {
  processes.broadcastArray(blocks, waiting);
  processes.broadcastArray(job, waiting);
}

DealtBlocks DealtBlocks::receive(Processes& processes) {
  DealtBlocks dealt;
  processes.broadcastArray(dealt.blocks);
  processes.broadcastArray(dealt.job);
  return dealt;
}

Dealing::Dealing(Processes& processes, const ExchangeMatrix& own, DealtBlocks dealt,
                 const MakeTaker& make_taker)
    : processes_(processes), own_(own), dealt_(std::move(dealt)) {
  guard([&] { taker_ = make_taker(dealt_.job); });
}

template <class Work>
void Dealing::guard(const Work& work) {
  if (!problem_.empty()) return;
  try {
    work();
  } catch (const std::exception& error) {
    problem_ = error.what();
  }
}

std::size_t Dealing::rounds() const {
  const auto processes = std::size_t(processes_.size());
  return (dealt_.blocks.size() + processes - 1) / processes;
}

std::size_t Dealing::rowsDone(std::size_t rounds) const {
  const auto processes = std::size_t(processes_.size());
  const std::size_t blocks = std::min(rounds * processes, dealt_.blocks.size());
  return blocks == 0 ? 0 : dealt_.blocks[blocks - 1].last;
}

std::string Dealing::round(std::size_t number, const WhileWaiting& waiting) {
  const auto processes = std::size_t(processes_.size());
  const auto rank = std::size_t(processes_.rank());
  const std::size_t first = number * processes;
  const auto blocks =
      std::span(dealt_.blocks).subspan(first, std::min(processes, dealt_.blocks.size() - first));
  std::vector<RowsPart> parts = exchangeParts(blocks, waiting);
  if (rank < blocks.size()) {
    rows_.first = blocks[rank].first;
    mergeParts(parts, own_.size(), rows_);
    guard([&] { taker_->take(first + rank, rows_); });
  }
  return reportProblems(waiting);
}

std::vector<RowsPart> Dealing::exchangeParts(std::span<const RowRange> blocks,
                                             const WhileWaiting& waiting) {
  const auto rank = std::size_t(processes_.rank());
  std::vector<RowsPart> parts(std::size_t(processes_.size()));
  std::vector<std::vector<std::byte>> messages(parts.size());
  {
    // One walk over this process's rows for all blocks, which are neighbours.
    const std::size_t first = blocks.front().first;
    const RowsPart all = partOf(own_, {first, blocks.back().last});
    for (std::size_t p = 0; p < blocks.size(); ++p) {
      RowsPart part = rowsOf(all, {blocks[p].first - first, blocks[p].last - first});
      if (p == rank) {
        parts[p] = std::move(part);
      } else {
        messages[p] = bytesOf(part);
      }
    }
  }
  messages = processes_.exchange(std::move(messages), waiting);
  if (rank >= blocks.size()) return {};
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (p != rank) parts[p] = partFrom(std::exchange(messages[p], {}));
  }
  return parts;
}

std::string Dealing::end(const WhileWaiting& waiting) {
  guard([&] { taker_->end(); });
  return reportProblems(waiting);
}

std::string Dealing::reportProblems(const WhileWaiting& waiting) {
  if (processes_.rank() != 0) {
    processes_.send(0, std::as_bytes(std::span(problem_)));
    return {};
  }
  std::string first = problem_;
  for (int p = 1; p < processes_.size(); ++p) {
    const Processes::Message message = processes_.receive(p, waiting);
    const auto* text = reinterpret_cast<const char*>(message.bytes.data());
    if (first.empty()) first.assign(text, message.bytes.size());
  }
  return first;
}

}  // namespace radiosity
