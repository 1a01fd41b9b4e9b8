#pragma once

#include <array>
#include <atomic>

namespace roundel {

// Hands values from one thread to one other, the newest only, without locks: neither side ever
// waits for the other. Three slots: one being written, one being read, one between them. A slot
// keeps its memory, so values that grow to a size once allocate no more.
template <typename Value>
class LatestValue {
 public:
  // The writer's slot. Holds an old value, to be overwritten.
  Value& back() { return slots_[back_]; }
  // Gives it to the reader; back() is another slot then.
  void publish() { back_ = between_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kIndex; }

  // The newest value if there is one since the last call, else nullptr. Holds until the next call.
  const Value* take() {
    if ((between_.load(std::memory_order_relaxed) & kFresh) == 0) return nullptr;
    front_ = between_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    return &slots_[front_];
  }

 private:
  static constexpr unsigned kIndex = 3, kFresh = 4;
  std::array<Value, 3> slots_;
  unsigned back_ = 0, front_ = 1;
  std::atomic<unsigned> between_{2};
};

}  // namespace roundel
