#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace roundel {

// syslog's priorities.
enum class LogLevel { kError = 3, kWarning = 4, kInfo = 6 };

// One line on standard error. Under systemd (JOURNAL_STREAM names standard error) the line starts
// with its priority, "<3>", which the journal takes off. Never used for every frame.
void write_log(LogLevel level, std::string_view message);

template <typename... Args>
void log_error(fmt::format_string<Args...> format, Args&&... args) {
  write_log(LogLevel::kError, fmt::format(format, std::forward<Args>(args)...));
}
template <typename... Args>
void log_warning(fmt::format_string<Args...> format, Args&&... args) {
  write_log(LogLevel::kWarning, fmt::format(format, std::forward<Args>(args)...));
}
template <typename... Args>
void log_info(fmt::format_string<Args...> format, Args&&... args) {
  write_log(LogLevel::kInfo, fmt::format(format, std::forward<Args>(args)...));
}

// Whether JOURNAL_STREAM's value ("device:inode") names this descriptor.
bool is_journal_stream(const char* value, int descriptor);

// The line as it is written, with its newline. Control characters in the message become spaces.
std::string log_line(LogLevel level, std::string_view message, bool journal);

}  // namespace roundel
