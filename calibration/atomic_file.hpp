#pragma once

#include <string>
#include <string_view>

#include "calibration/unique_fd.hpp"

namespace roundel {

// The new contents of a file, complete and on the disk under another name beside it: what can fail,
// as on a full disk, has been done before anything is replaced. Goes away unless it takes its
// place. What a power cut has left of an earlier one is removed.
class StagedFile {
 public:
  // Throws std::runtime_error that names the file.
  StagedFile(const std::string& path, std::string_view contents);
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  // Once. Throws like the constructor.
  void take_its_place();

 private:
  std::string path_, name_;  // name_: empty when it has taken its place
  UniqueFd descriptor_;      // locked, so that nobody takes it for what was left behind
};

// Replaces a file as a whole: a temporary file beside it is written, synced and renamed, and the
// folder is synced. After a power loss at any instant the old or the new contents are there.
// Throws std::runtime_error that names the file; the old contents are untouched then.
void write_file_atomically(const std::string& path, std::string_view contents);

// Makes a change of names beside a file last. Throws like it.
void sync_folder_of(const std::string& path);

// Throws like it if a file of that name can't be written now, without touching it.
void require_writable(const std::string& path);

}  // namespace roundel
