#include "daemon/log.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string>

namespace roundel {
namespace {

std::string_view name_of(LogLevel level) {
  switch (level) {
    case LogLevel::kError:
      return "error: ";
    case LogLevel::kWarning:
      return "warning: ";
    default:
      return "";
  }
}

}  // namespace

bool is_journal_stream(const char* value, int descriptor) {
  struct stat status {};
  if (value == nullptr || ::fstat(descriptor, &status) != 0) return false;
  return fmt::format("{}:{}", status.st_dev, status.st_ino) == value;
}

std::string log_line(LogLevel level, std::string_view message, bool journal) {
  std::string line = journal ? fmt::format("<{}>{}\n", static_cast<int>(level), message)
                             : fmt::format("roundeld: {}{}\n", name_of(level), message);
  std::replace_if(
      line.begin(), line.end() - 1, [](char c) { return static_cast<unsigned char>(c) < 0x20; },
      ' ');
  return line;
}

void write_log(LogLevel level, std::string_view message) {
  static const bool journal = is_journal_stream(std::getenv("JOURNAL_STREAM"), STDERR_FILENO);
  const std::string line = log_line(level, message, journal);
  // In one piece; there is nobody to tell if it fails.
  static_cast<void>(!::write(STDERR_FILENO, line.data(), line.size()));
}

}  // namespace roundel
