#include "tools/json_lines.hpp"

#include <doctest/doctest.h>

#include <string>

#include "tests/error_of.hpp"
#include "tests/temporary_directory.hpp"
#include "tests/tools/run_roundel.hpp"

namespace roundel {
namespace {

// The error met in reading a file of these contents to its end.
std::string error_in(const std::string& contents) {
  const TemporaryDirectory folder;
  const std::string path = folder.write("a.jsonl", contents);
  std::string error = error_of([&] {
    JsonLines lines(path);
    while (lines.next()) {
    }
  });
  if (!error.empty()) {
    CHECK(error.starts_with(path));
    error.erase(0, path.size());
  }
  return error;
}

}  // namespace

TEST_CASE("JSON Lines are read one by one, with or without a last line end") {
  const TemporaryDirectory folder;
  JsonLines lines(folder.write("a.jsonl", "{\"a\":1}\n[2]\n3"));
  CHECK(lines.next() == nlohmann::ordered_json({{"a", 1}}));
  CHECK(lines.next() == nlohmann::ordered_json::array({2}));
  CHECK(lines.next() == nlohmann::ordered_json(3));
  CHECK_FALSE(lines.next());
  CHECK_FALSE(lines.next());
}

TEST_CASE("a broken line is named by file and number") {
  CHECK(error_in("{}\n{}\n") == "");
  CHECK(error_in("{}\n{\"a\":\n{}\n") == ":2: is not JSON (character 6)");
  CHECK(error_in("{}\n\n") == ":2: is not JSON (character 1)");
  CHECK(error_in("nonsense") == ":1: is not JSON (character 2)");
  CHECK(error_in("{\"a\":1e999}") == ":1: is not JSON that can be read");
  CHECK(error_in("{\"a\":NaN}") != "");
  CHECK(error_in(std::string("\0\n", 2)) != "");
  CHECK(error_in("\"\xff\"") != "");
}

TEST_CASE("lines are bounded in length and nesting") {
  const std::string longest = '"' + std::string(JsonLines::kMaxLine - 2, 'x') + '"';
  CHECK(error_in(longest + "\n" + longest) == "");
  CHECK(error_in("1\n" + longest + " \n") == ":2: is longer than 8388608 bytes");

  const auto nested = [](std::size_t depth) {
    return std::string(depth, '[') + std::string(depth, ']');
  };
  CHECK(error_in(nested(JsonLines::kMaxDepth)) == "");
  CHECK(error_in(nested(1'000'000)) == ":1: is nested more than 16 deep");
}

TEST_CASE("a file that can't be read is named") {
  CHECK(contains(error_of([] { JsonLines("/nowhere/a"); }), "/nowhere/a can't be opened: No such"));
  CHECK(error_of([] { JsonLines("/").next(); }) == "/:1: can't be read: Is a directory");
}

}  // namespace roundel
