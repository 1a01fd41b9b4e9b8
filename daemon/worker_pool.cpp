#include "daemon/worker_pool.hpp"

namespace roundel {

WorkerPool::WorkerPool(int count) {
  threads_.reserve(static_cast<std::size_t>(count));
  try {
    for (int worker = 1; worker < count; ++worker) {
      threads_.emplace_back([this, worker] { work(worker); });
    }
  } catch (...) {
    end();
    throw;
  }
}

WorkerPool::~WorkerPool() {
  end();
}

void WorkerPool::end() {
  ending_ = true;
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void WorkerPool::run(Task task, void* context) {
  task_ = task;
  context_ = context;
  busy_.store(static_cast<int>(threads_.size()), std::memory_order_relaxed);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  task(context, 0);
  for (int left = busy_.load(std::memory_order_acquire); left != 0;
       left = busy_.load(std::memory_order_acquire)) {
    busy_.wait(left, std::memory_order_acquire);
  }
}

void WorkerPool::work(int worker) {
  for (std::uint32_t last_round = 0;; ++last_round) {
    round_.wait(last_round, std::memory_order_acquire);
    if (ending_) return;
    task_(context_, worker);
    if (busy_.fetch_sub(1, std::memory_order_acq_rel) == 1) busy_.notify_one();
  }
}

}  // namespace roundel
