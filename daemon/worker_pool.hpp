#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "core/workers.hpp"

namespace roundel {

// A fixed number of threads that wait for a part of a frame. No allocation and no lock after the
// constructor; to be run by one thread at a time.
class WorkerPool final : public Workers {
 public:
  // Starts count - 1 threads. Throws std::system_error where there can't be so many.
  explicit WorkerPool(int count);
  ~WorkerPool() override;

  int count() const override { return static_cast<int>(threads_.size()) + 1; }
  void run(Task task, void* context) override;

 private:
  void work(int worker);
  void end();

  std::vector<std::thread> threads_;
  Task task_ = nullptr;
  void* context_ = nullptr;
  bool ending_ = false;
  std::atomic<std::uint32_t> round_{0};  // counts runs; what they are about is written before
  std::atomic<int> busy_{0};             // threads that have not finished this run
};

}  // namespace roundel
