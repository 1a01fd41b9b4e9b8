#include "calibration/bounded_yaml.hpp"

#include <doctest/doctest.h>

#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <string>

#include "calibration/unique_fd.hpp"
#include "tests/error_of.hpp"
#include "tests/temporary_directory.hpp"

using namespace roundel;

namespace {

std::string error_for(const std::string& text) {
  return error_of([&] { parse_bounded_yaml(text, "file.yaml"); });
}

std::string repeated(const std::string& piece, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += piece;
  return text;
}

}  // namespace

TEST_CASE("broken YAML is an error with file, line and column") {
  CHECK(error_for("a: 1\nb: [1, 2\nc: 3\n").starts_with("file.yaml:3:"));
  CHECK(error_for("a: 1\n\tb: 2\n").starts_with("file.yaml:2:"));
}

TEST_CASE("YAML nested too deep is refused in every way of nesting") {
  for (const int depth : {17, 1000, 50000}) {
    CAPTURE(depth);
    CHECK(error_for(repeated("[", depth)).find("nested deeper") != std::string::npos);
    CHECK(error_for(repeated("[", depth).append(repeated("]", depth)))
              .starts_with("file.yaml:1:17: nested deeper than 16 levels"));
    CHECK(error_for(repeated("{a: ", depth)).find("nested deeper") != std::string::npos);
    CHECK(error_for(repeated("- ", depth) + "1").find("nested deeper") != std::string::npos);
    CHECK(error_for(repeated("? ", depth) + "1").find("nested deeper") != std::string::npos);
  }
  CHECK(error_for(repeated("[", 16) + repeated("]", 16)).empty());
}

TEST_CASE("YAML that is too large is refused before it is parsed") {
  CHECK(error_for(std::string(300000, ' ')) ==
        "file.yaml: too large for such a file, at most 262144 bytes");
  const TemporaryDirectory folder;
  const std::string path = folder.write("large.yaml", std::string(300000, '#'));
  CHECK(error_of([&] { read_text_file(path); }) ==
        path + ": too large for such a file, at most 262144 bytes");
  CHECK(error_of([] { read_text_file("/dev/zero"); }).find("too large") != std::string::npos);
  CHECK(error_for(repeated("- 1\n", 30000)).find("more than 20000 values") != std::string::npos);
}

TEST_CASE("aliases and second documents are refused") {
  CHECK(error_for("a: &x [1]\nb: *x\n").find("aliases") != std::string::npos);
  CHECK(error_for("a: &x [*x]\n").find("aliases") != std::string::npos);
  CHECK(error_for("a: 1\n---\nb: 2\n").find("only one") != std::string::npos);
}

TEST_CASE("a file that can't be read is an error that names it") {
  CHECK(error_of([] { read_text_file("/nonexistent/a.yaml"); }) ==
        "/nonexistent/a.yaml: can't be opened: No such file or directory");
  CHECK(error_of([] { read_text_file("/"); }) == "/: can't be read: Is a directory");
  CHECK(error_of([] { read_text_file("/dev/zero"); }).find("too large") != std::string::npos);
}

TEST_CASE("a pipe that nobody writes to is empty, and one that somebody writes to is read") {
  const TemporaryDirectory folder;
  const std::string path = folder.file("pipe");
  REQUIRE(::mkfifo(path.c_str(), 0600) == 0);
  CHECK(read_text_file(path).empty());
  std::array<int, 2> ends{};
  REQUIRE(::pipe(ends.data()) == 0);
  const UniqueFd reading(ends[0]);
  UniqueFd writing(ends[1]);
  REQUIRE(::write(writing.get(), "a: 1\n", 5) == 5);
  writing.reset();
  CHECK(read_text_file("/dev/fd/" + std::to_string(reading.get())) == "a: 1\n");
}

TEST_CASE("empty YAML is a null node") {
  CHECK(parse_bounded_yaml("", "file.yaml").IsNull());
  CHECK(parse_bounded_yaml("# only a comment\n", "file.yaml").IsNull());
}
