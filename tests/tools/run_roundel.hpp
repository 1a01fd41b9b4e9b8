#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "tests/temporary_directory.hpp"

namespace roundel {

struct CommandResult {
  int status = -1;  // exit status; -1: it did not exit by itself
  std::string out, err;
};

// Runs a shell command, its standard input empty unless it says otherwise.
inline CommandResult run_command(const std::string& command) {
  const TemporaryDirectory directory;
  const std::string line =
      "{ " + command + "; } </dev/null >" + directory.file("out") + " 2>" + directory.file("err");
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(directory.file("out")),
          read_file(directory.file("err"))};
}

// Runs the real program.
inline CommandResult run_roundel(const std::string& arguments) {
  return run_command(ROUNDEL_BINARY " " + arguments);
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace roundel
