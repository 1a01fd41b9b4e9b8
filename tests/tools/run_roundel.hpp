#pragma once

#include <doctest/doctest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

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

// One line on standard error that begins with the command and contains the words; nothing else.
inline void check_refused(const std::string& arguments, int status, const std::string& words) {
  const CommandResult result = run_roundel(arguments);
  CAPTURE(arguments);
  CAPTURE(result.err);
  CHECK(result.status == status);
  CHECK(contains(result.err, words));
  CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  CHECK(result.err.ends_with('\n'));
  CHECK(result.err.starts_with("roundel"));
}

inline std::vector<nlohmann::json> json_lines(const std::string& text) {
  std::vector<nlohmann::json> lines;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = text.find('\n', start);
    REQUIRE(end != std::string::npos);
    lines.push_back(nlohmann::json::parse(text.substr(start, end - start)));
    start = end + 1;
  }
  return lines;
}

}  // namespace roundel
