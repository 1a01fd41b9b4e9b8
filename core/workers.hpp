#pragma once

namespace roundel {

// Threads that somebody lends for a part of every frame: core/ has none of its own.
class Workers {
 public:
  using Task = void (*)(void* context, int worker);

  Workers() = default;
  virtual ~Workers() = default;
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  virtual int count() const = 0;  // at least 1: the caller of run() is one of them

  // Calls the task for worker 0 to count() - 1, side by side, and returns when all have returned.
  // The task must not throw.
  virtual void run(Task task, void* context) = 0;
};

}  // namespace roundel
