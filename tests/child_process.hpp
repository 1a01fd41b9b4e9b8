#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "calibration/unique_fd.hpp"

namespace roundel {

// A program that a test runs, with its output read as it comes. Killed if the test ends first.
class ChildProcess {
 public:
  explicit ChildProcess(const std::vector<std::string>& command);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  int pid() const { return pid_; }
  void signal(int number) const;
  // A line of /proc/PID/status, "VmRSS:" for instance; 0 if it has ended.
  long memory_kb(const std::string& line) const;

  // Waits until the program has written the text (to either stream) after what was waited for
  // before. False if the time is over or the program has ended without it.
  bool wait_for(const std::string& text, std::chrono::milliseconds timeout);

  // Waits for the program's end. Its exit status; 128 + signal; nothing if the time is over.
  std::optional<int> wait(std::chrono::milliseconds timeout);

  // Everything it has written so far (all of it after wait() gave a status).
  const std::string& output() const { return out_.text; }
  const std::string& errors() const { return err_.text; }

 private:
  struct Stream {
    UniqueFd pipe;
    std::string text;
    std::size_t waited_for = 0;
  };
  // Waits for anything to be read; false at the deadline or when both streams have ended.
  bool read_more(std::chrono::steady_clock::time_point deadline);

  int pid_ = -1;
  Stream out_, err_;
  std::optional<int> status_;
};

// Runs a program to its end.
struct Finished {
  int status = -1;  // -1: it did not end within a minute
  std::string output, errors;
};
Finished run_program(const std::vector<std::string>& command);

}  // namespace roundel
