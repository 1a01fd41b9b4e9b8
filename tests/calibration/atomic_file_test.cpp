#include "calibration/atomic_file.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <iterator>

#include "tests/temporary_folder.hpp"

using namespace roundel;

TEST_CASE("a file is replaced as a whole and nothing else is left in its folder") {
  const TemporaryFolder folder;
  const std::string path = folder.write("a.yaml", "a long old text");
  write_file_atomically(path, "new");
  CHECK(file_contents(path) == "new");
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path("")), {}) == 1);
}

TEST_CASE("a file that can't be written is an error and leaves no temporary file") {
  const TemporaryFolder folder;
  CHECK(error_of([&] {
          write_file_atomically(folder.path("none/a.yaml"), "x");
        }).starts_with(folder.path("none/a.yaml") + ": can't be written"));
  std::filesystem::create_directory(folder.path("taken"));
  CHECK(error_of([&] {
          write_file_atomically(folder.path("taken"), "x");
        }).starts_with(folder.path("taken") + ": can't be replaced"));
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path("")), {}) == 1);
}
