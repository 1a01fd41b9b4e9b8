#include "config/fields.hpp"

#include <doctest/doctest.h>
#include <yaml-cpp/yaml.h>

#include <set>
#include <string>

#include "config/default_yaml.hpp"
#include "config/reader.hpp"

using namespace roundel;

namespace {

std::set<std::string> keys_of_sample_file() {
  std::set<std::string> keys;
  const YAML::Node document = YAML::Load(std::string(default_yaml()));
  for (const auto& top : document) {
    const std::string section = top.first.Scalar();
    if (!top.second.IsMap()) keys.insert(section);
    if (!top.second.IsMap()) continue;
    for (const auto& entry : top.second) keys.insert(section + "." + entry.first.Scalar());
  }
  return keys;
}

}  // namespace

TEST_CASE("the sample file has every key and no other") {
  std::set<std::string> known;
  for (const Field& field : fields()) known.insert(std::string(field.key));
  CHECK(keys_of_sample_file() == known);
  CHECK(known.size() == fields().size());
}

TEST_CASE("every key of the sample file has the default of its struct") {
  const LoadedConfiguration sample = default_configuration();
  CHECK(changed_keys(sample.values, Configuration{}).empty());
  CHECK(sample.origins.contains("lcm.max_datagram"));
}

TEST_CASE("every default lies in its own range") {
  for (const Field& field : fields()) {
    CAPTURE(field.key);
    Configuration defaults;
    const FieldTarget target = field.target(defaults);
    const auto in_range = [&](double value) { return value >= field.min && value <= field.max; };
    if (const auto* whole = std::get_if<int*>(&target)) CHECK(in_range(**whole));
    if (const auto* number = std::get_if<double*>(&target)) CHECK(in_range(**number));
    if (const auto* text = std::get_if<std::string*>(&target)) {
      CHECK(in_range(static_cast<double>((*text)->size())));
    }
    if (field.rule != nullptr) CHECK(field.rule(target));
    CHECK_FALSE(accepted_values(field).empty());
  }
}

TEST_CASE("changed keys are named, whatever their type") {
  const Configuration a;
  Configuration b;
  CHECK(changed_keys(a, b).empty());
  b.simulator.robots = 3;
  b.files.paths = {"a.png"};
  b.detector.min_contrast = 30;
  b.lcm.per_marker = true;
  b.source = SourceKind::kFiles;
  CHECK(changed_keys(a, b) == std::vector<std::string_view>{"source", "simulator.robots",
                                                            "files.paths", "detector.min_contrast",
                                                            "lcm.per_marker"});
}
