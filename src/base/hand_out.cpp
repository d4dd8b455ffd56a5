#include "base/hand_out.h"

#include <atomic>
#include <chrono>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "base/byte_stream.h"

namespace radiosity {

namespace {

constexpr std::size_t kNoBlock = std::size_t(-1);

/// The blocks that nobody has yet. Thread-safe.
class BlocksLeft {
 public:
  explicit BlocksLeft(const BlockWork& work) : work_(work) {}

  /// The next block for a process that has had `taken`; kNoBlock if none is left or it has had its
  /// most.
  std::size_t take(std::size_t& taken) {
    if (taken == work_.most_a_process) return kNoBlock;
    const std::size_t block = next_++;
    if (block >= work_.blocks) return kNoBlock;
    ++taken;
    return block;
  }
  /// Leaves none.
  void clear() { next_ = work_.blocks; }

 private:
  const BlockWork& work_;
  std::atomic<std::size_t> next_{0};
};

std::vector<std::byte> answer(std::size_t block, std::span<const std::byte> bytes) {
  ByteWriter writer;
  writer.put(block);
  writer.putArray(bytes);
  return {writer.bytes().begin(), writer.bytes().end()};
}

void workForOthers(Processes& processes, const BlockWork& work) {
  std::vector<std::byte> done = answer(kNoBlock, {});
  for (;;) {
    processes.send(0, done);
    const Processes::Message next = processes.receive(0);
    ByteReader reader(next.bytes);
    const auto block = reader.get<std::size_t>();
    if (block == kNoBlock) return;
    done = answer(block, work.run(block));
  }
}

/// Computes process 0's own share in a thread beside the one that hands out.
class OwnShare {
 public:
  OwnShare(const BlockWork& work, BlocksLeft& left)
      : work_(work), left_(left), thread_([this] { run(); }) {}
  ~OwnShare() {
    left_.clear();
    thread_.join();
  }
  OwnShare(const OwnShare&) = delete;
  OwnShare& operator=(const OwnShare&) = delete;

  /// Passes finished blocks to take() and returns their number; rethrows exceptions of the work.
  std::size_t collect() {
    std::deque<std::pair<std::size_t, std::vector<std::byte>>> done;
    {
      const std::lock_guard lock(mutex_);
      if (failure_) std::rethrow_exception(failure_);
      done.swap(done_);
    }
    for (const auto& [block, bytes] : done) work_.take(block, bytes, 0);
    return done.size();
  }

 private:
  void run() {
    try {
      std::size_t taken = 0;
      for (;;) {
        const std::size_t block = left_.take(taken);
        if (block == kNoBlock) return;
        std::vector<std::byte> bytes = work_.run(block);
        const std::lock_guard lock(mutex_);
        done_.emplace_back(block, std::move(bytes));
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      failure_ = std::current_exception();
    }
  }

  const BlockWork& work_;
  BlocksLeft& left_;
  std::mutex mutex_;
  std::deque<std::pair<std::size_t, std::vector<std::byte>>> done_;
  std::exception_ptr failure_;
  std::thread thread_;
};

/// Hands blocks to the other processes.
class OtherShares {
 public:
  OtherShares(Processes& processes, const BlockWork& work, BlocksLeft& left)
      : processes_(processes),
        work_(work),
        left_(left),
        taken_(std::size_t(processes.size()), 0),
        working_(processes.size() - 1) {}

  bool working() const { return working_ > 0; }

  /// Takes the result of a process and gives it the next block. True if it had done a block.
  bool serve() {
    const Processes::Message message = processes_.receive(Processes::kAny);
    ByteReader reader(message.bytes);
    const auto done = reader.get<std::size_t>();
    const std::vector<std::byte> bytes = reader.getArray<std::byte>();
    const std::size_t block = left_.take(taken_[std::size_t(message.from)]);
    if (block == kNoBlock) --working_;
    processes_.send(message.from, std::as_bytes(std::span(&block, 1)));
    if (done == kNoBlock) return false;
    work_.take(done, bytes, message.from);
    return true;
  }

 private:
  Processes& processes_;
  const BlockWork& work_;
  BlocksLeft& left_;
  std::vector<std::size_t> taken_;  // blocks, by process
  int working_;
};

}  // namespace

void handOut(Processes& processes, const BlockWork& work, Progress& progress) {
  if (processes.rank() != 0) return workForOthers(processes, work);
  constexpr std::chrono::milliseconds kBetweenLooks{1};
  BlocksLeft left(work);
  OwnShare own(work, left);
  OtherShares others(processes, work, left);
  for (std::size_t done = 0; done < work.blocks || others.working();) {
    progress.check();
    done += own.collect();
    if (processes.hasMessage()) {
      done += others.serve() ? 1 : 0;
    } else {
      std::this_thread::sleep_for(kBetweenLooks);
    }
  }
}

}  // namespace radiosity
