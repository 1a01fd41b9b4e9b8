#include "calibration/atomic_file.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include "tests/error_of.hpp"
#include "tests/temporary_directory.hpp"

using namespace roundel;

TEST_CASE("a file is replaced as a whole and nothing else is left in its folder") {
  const TemporaryDirectory folder;
  const std::string path = folder.write("a.yaml", "a long old text");
  write_file_atomically(path, "new");
  CHECK(read_file(path) == "new");
  CHECK(std::distance(std::filesystem::directory_iterator(folder.file("")), {}) == 1);
}

TEST_CASE("a file that can't be written is an error and leaves no temporary file") {
  const TemporaryDirectory folder;
  CHECK(error_of([&] {
          write_file_atomically(folder.file("none/a.yaml"), "x");
        }).starts_with(folder.file("none/a.yaml") + ": can't be written"));
  std::filesystem::create_directory(folder.file("taken"));
  CHECK(error_of([&] {
          write_file_atomically(folder.file("taken"), "x");
        }).starts_with(folder.file("taken") + ": can't be replaced"));
  CHECK(std::distance(std::filesystem::directory_iterator(folder.file("")), {}) == 1);
}

TEST_CASE("what a power cut left behind is removed by the next writer, what others write is not") {
  const TemporaryDirectory folder;
  const std::string path = folder.file("a.yaml");
  folder.write("a.yaml.Ab3dEf.new", "left behind");
  const std::vector<std::string> others = {"a.yaml.backup", "a.yaml.previous", "b.yaml.Ab3dEf.new",
                                           "a.yaml.long-name.new"};
  for (const std::string& name : others) folder.write(name, "a user's");
  const StagedFile staged(path, "another writer's");
  write_file_atomically(path, "new");
  CHECK(std::distance(std::filesystem::directory_iterator(folder.file("")), {}) ==
        static_cast<std::ptrdiff_t>(others.size()) + 2);
  CHECK_FALSE(std::filesystem::exists(folder.file("a.yaml.Ab3dEf.new")));
}

TEST_CASE("a staged file changes nothing until it takes its place") {
  const TemporaryDirectory folder;
  const std::string path = folder.write("a.yaml", "old");
  { const StagedFile staged(path, "never"); }
  StagedFile staged(path, "new");
  CHECK(read_file(path) == "old");
  staged.take_its_place();
  CHECK(read_file(path) == "new");
  CHECK(std::distance(std::filesystem::directory_iterator(folder.file("")), {}) == 1);
}
