#include "config/writer.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "config/fields.hpp"

namespace roundel {
namespace {

constexpr const char* kRemoved = "taken-out-of-this-copy";  // long enough for a token

const char* name_of(SourceKind kind) {
  switch (kind) {
    case SourceKind::kSimulator:
      return "simulator";
    case SourceKind::kFiles:
      return "files";
    case SourceKind::kCamera:
      return "camera";
  }
  return "";
}

// Text is quoted, so that it stays text whatever it looks like.
struct EmitValue {
  YAML::Emitter& out;

  void operator()(const bool* value) const { out << *value; }
  void operator()(const int* value) const { out << *value; }
  // The fewest digits that give the same number again.
  void operator()(const double* value) const { out << fmt::format("{}", *value); }
  void operator()(const std::string* value) const { out << YAML::DoubleQuoted << *value; }
  void operator()(const std::vector<std::string>* value) const {
    out << YAML::Flow << YAML::BeginSeq;
    for (const std::string& element : *value) out << YAML::DoubleQuoted << element;
    out << YAML::EndSeq;
  }
  void operator()(const std::map<std::string, std::string>* value) const {
    out << YAML::Flow << YAML::BeginMap;
    for (const auto& [name, element] : *value) {
      out << YAML::Key << YAML::DoubleQuoted << name << YAML::Value << YAML::DoubleQuoted
          << element;
    }
    out << YAML::EndMap;
  }
  void operator()(const SourceKind* value) const { out << name_of(*value); }
};

}  // namespace

std::string configuration_yaml(const Configuration& configuration) {
  Configuration values = configuration;  // targets are not const
  if (!values.control.token.empty()) values.control.token = kRemoved;
  YAML::Emitter out;
  out << YAML::BeginMap;
  std::string_view section;
  for (const Field& field : fields()) {
    const std::size_t dot = field.key.find('.');
    const std::string_view its_section =
        dot == std::string_view::npos ? std::string_view() : field.key.substr(0, dot);
    if (its_section != section) {
      if (!section.empty()) out << YAML::EndMap;
      section = its_section;
      if (!section.empty()) {
        out << YAML::Key << std::string(section) << YAML::Value << YAML::BeginMap;
      }
    }
    const std::size_t start = section.empty() ? 0 : dot + 1;
    out << YAML::Key << std::string(field.key.substr(start)) << YAML::Value;
    std::visit(EmitValue{out}, field.target(values));
  }
  if (!section.empty()) out << YAML::EndMap;
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

}  // namespace roundel
