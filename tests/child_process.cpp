#include "tests/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <fstream>
#include <stdexcept>

namespace roundel {
namespace {

using Clock = std::chrono::steady_clock;

int milliseconds_until(Clock::time_point deadline) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
  return static_cast<int>(std::max<std::int64_t>(0, left));
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command) {
  std::array<int, 2> out{}, err{};
  if (::pipe2(out.data(), O_CLOEXEC) != 0 || ::pipe2(err.data(), O_CLOEXEC) != 0) {
    throw std::runtime_error("no pipe");
  }
  std::vector<char*> arguments;
  for (const std::string& argument : command)
    arguments.push_back(const_cast<char*>(argument.data()));
  arguments.push_back(nullptr);
  pid_ = ::fork();
  if (pid_ < 0) throw std::runtime_error("no fork");
  if (pid_ == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::dup2(out[1], STDOUT_FILENO);
    ::dup2(err[1], STDERR_FILENO);
    ::execv(arguments[0], arguments.data());
    ::_exit(127);
  }
  out_.pipe = UniqueFd(out[0]);
  err_.pipe = UniqueFd(err[0]);
  ::close(out[1]);
  ::close(err[1]);
}

ChildProcess::~ChildProcess() {
  if (status_) return;
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

void ChildProcess::signal(int number) const {
  ::kill(pid_, number);
}

long ChildProcess::memory_kb(const std::string& line) const {
  std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
  std::string word;
  long kb = 0;
  while (status >> word) {
    if (word == line) status >> kb;
  }
  return kb;
}

bool ChildProcess::read_more(Clock::time_point deadline) {
  std::array<pollfd, 2> descriptors = {
      {{out_.pipe.get(), POLLIN, 0}, {err_.pipe.get(), POLLIN, 0}}};
  if (::poll(descriptors.data(), descriptors.size(), milliseconds_until(deadline)) <= 0) {
    return false;
  }
  bool open = false;
  for (std::size_t i = 0; i < 2; ++i) {
    Stream& stream = i == 0 ? out_ : err_;
    if (descriptors[i].revents == 0) {
      open = open || stream.pipe.get() >= 0;
      continue;
    }
    std::array<char, 4096> buffer{};
    const ssize_t count = ::read(stream.pipe.get(), buffer.data(), buffer.size());
    if (count > 0) {
      stream.text.append(buffer.data(), static_cast<std::size_t>(count));
      open = true;
    } else {
      stream.pipe.reset();
    }
  }
  return open;
}

bool ChildProcess::wait_for(const std::string& text, std::chrono::milliseconds timeout) {
  const Clock::time_point deadline = Clock::now() + timeout;
  for (bool more = true; more;) {
    for (Stream* stream : {&out_, &err_}) {
      const std::size_t at = stream->text.find(text, stream->waited_for);
      if (at == std::string::npos) continue;
      stream->waited_for = at + text.size();
      return true;
    }
    more = read_more(deadline);
  }
  return false;
}

std::optional<int> ChildProcess::wait(std::chrono::milliseconds timeout) {
  const Clock::time_point deadline = Clock::now() + timeout;
  while (read_more(deadline)) {
  }
  if (status_) return status_;
  // Both streams have ended, so the program has, or the time is over.
  if (out_.pipe || err_.pipe) return std::nullopt;
  int status = 0;
  if (::waitpid(pid_, &status, 0) != pid_) return std::nullopt;
  status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return status_;
}

Finished run_program(const std::vector<std::string>& command) {
  ChildProcess child(command);
  const std::optional<int> status = child.wait(std::chrono::minutes(1));
  return {status.value_or(-1), child.output(), child.errors()};
}

}  // namespace roundel
