#pragma once

#include <cstdint>
#include <string>

namespace roundel {

enum class Verdict : std::uint8_t { kOk, kWarning, kProblem };

// What one check of `roundel doctor` has found.
struct Finding {
  std::string check;  // its name, one word or two
  Verdict verdict = Verdict::kOk;
  std::string text;    // what is the case
  std::string remedy;  // how to mend it; empty where there is nothing to mend
};

// Whatever is read of a machine is read below a folder, "/" for this one; tests make their own.
struct MachineRoot {
  std::string path = "/";

  std::string of(const std::string& absolute) const { return path + absolute; }
  // The file's text without the space at its end; empty if it can't be read.
  std::string read(const std::string& absolute) const;
  bool exists(const std::string& absolute) const;
};

}  // namespace roundel
