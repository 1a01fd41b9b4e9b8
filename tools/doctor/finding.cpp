#include "tools/doctor/finding.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>

namespace roundel {

std::string MachineRoot::read(const std::string& absolute) const {
  std::ifstream file(of(absolute), std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(file), {});
  while (!text.empty() && static_cast<unsigned char>(text.back()) <= ' ') text.pop_back();
  return text;
}

bool MachineRoot::exists(const std::string& absolute) const {
  std::error_code error;
  return std::filesystem::exists(of(absolute), error);
}

}  // namespace roundel
