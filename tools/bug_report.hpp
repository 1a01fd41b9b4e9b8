#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/archive_writer.hpp"
#include "tools/control_client.hpp"

namespace roundel {

struct BugReportOptions {
  std::string socket = kDefaultControlSocket;
  std::string config;  // empty: the installed one
  double seconds = 2;  // of frames; 0: none
};

// The text of a configuration or log without what is nobody's business: values of keys that end
// with token, password or secret.
std::string without_secrets(std::string_view text);

// What a program prints on both streams, at most so much of its end; and why, if it fails.
std::string output_of(const std::string& command);

// Puts everything into the archive that helps to find out what is wrong. What can't be had (no
// roundeld runs, the log may not be read) is left out, and the reason is put in its place. Returns
// a line for every file: its name and what it is.
std::vector<std::string> fill_bug_report(ArchiveWriter& archive, const BugReportOptions& options);

}  // namespace roundel
