#pragma once

namespace roundel {

// Counts the heap allocations (malloc and its relatives, so also operator new and those inside C
// libraries) of this thread during its life. Works under the sanitizers as well. Not nested.
class AllocationCounter {
 public:
  AllocationCounter();
  ~AllocationCounter();
  AllocationCounter(const AllocationCounter&) = delete;
  AllocationCounter& operator=(const AllocationCounter&) = delete;

  long count() const;
};

}  // namespace roundel
