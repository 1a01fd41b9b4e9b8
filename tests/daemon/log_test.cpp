#include "daemon/log.hpp"

#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>

using namespace roundel;

TEST_CASE("the journal gets the priority, a terminal gets words") {
  CHECK(log_line(LogLevel::kError, "it broke", true) == "<3>it broke\n");
  CHECK(log_line(LogLevel::kWarning, "careful", true) == "<4>careful\n");
  CHECK(log_line(LogLevel::kInfo, "hello", true) == "<6>hello\n");
  CHECK(log_line(LogLevel::kError, "it broke", false) == "roundeld: error: it broke\n");
  CHECK(log_line(LogLevel::kInfo, "hello", false) == "roundeld: hello\n");
}

TEST_CASE("a message stays on one line whatever it holds") {
  CHECK(log_line(LogLevel::kInfo, "a\nb\x1b[2Jc\td", true) == "<6>a b [2Jc d\n");
}

TEST_CASE("the journal is recognised by the device and inode of the stream") {
  std::FILE* const file = std::tmpfile();
  REQUIRE(file != nullptr);
  struct stat status {};
  REQUIRE(::fstat(::fileno(file), &status) == 0);
  const std::string name = fmt::format("{}:{}", status.st_dev, status.st_ino);
  CHECK(is_journal_stream(name.c_str(), ::fileno(file)));
  CHECK_FALSE(is_journal_stream("8:1", ::fileno(file)));
  CHECK_FALSE(is_journal_stream(nullptr, ::fileno(file)));
  CHECK_FALSE(is_journal_stream(name.c_str(), -1));
  std::fclose(file);
}
