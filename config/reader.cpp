#include "config/reader.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>

#include "calibration/bounded_yaml.hpp"
#include "config/default_yaml.hpp"
#include "config/fields.hpp"
#include "config/suggestion.hpp"
#include "config/web_address.hpp"

namespace roundel {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 16;
constexpr std::size_t kMaxShown = 60;  // characters of a wrong value that a message repeats
constexpr std::size_t kMaxListLength = 10000;

// A value as an error message shows it: short and on one line.
std::string shown(std::string text) {
  if (text.size() > kMaxShown) text.replace(kMaxShown, std::string::npos, "...");
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  return fmt::format("\"{}\"", text);
}

// Quotes make a value text.
bool is_quoted(const YAML::Node& node) {
  return node.Tag() == "!";
}

template <typename Number>
std::optional<Number> parse_number(const YAML::Node& node) {
  if (!node.IsScalar() || is_quoted(node)) return std::nullopt;
  const std::string& text = node.Scalar();
  const char* const end = text.data() + text.size();
  Number value = 0;
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

// Reads one value into its place. Returns what is wrong with it; empty if nothing is.
struct ReadValue {
  const Field& field;
  const YAML::Node& node;

  std::string operator()(bool* target) const {
    if (!node.IsScalar() || is_quoted(node) ||
        (node.Scalar() != "true" && node.Scalar() != "false"))
      return "is not true or false";
    *target = node.Scalar() == "true";
    return {};
  }
  std::string operator()(int* target) const {
    const std::optional<double> number = parse_number<double>(node);
    if (!number) return "is not a whole number";
    if (!in_range(*number)) return "is out of range";
    const std::optional<int> whole = parse_number<int>(node);
    if (!whole) return "is not a whole number";
    *target = *whole;
    return {};
  }
  std::string operator()(double* target) const {
    const std::optional<double> number = parse_number<double>(node);
    if (!number) return "is not a number";
    if (!in_range(*number)) return "is out of range";
    *target = *number;
    return {};
  }
  std::string operator()(std::string* target) const {
    if (node.IsNull()) {
      target->clear();
    } else if (node.IsScalar()) {
      *target = node.Scalar();
    } else {
      return "is not text";
    }
    if (target->find('\0') != std::string::npos) return "has a zero byte in it";
    return in_range(static_cast<double>(target->size())) ? "" : "has a wrong length";
  }
  std::string operator()(std::vector<std::string>* target) const {
    target->clear();
    if (!node.IsSequence()) return "is not a list";
    if (node.size() > kMaxListLength) return "is too long";
    for (const YAML::Node& element : node) {
      if (!element.IsScalar() || element.Scalar().empty() ||
          element.Scalar().find('\0') != std::string::npos) {
        return "has an element that is not text";
      }
      target->push_back(element.Scalar());
    }
    return {};
  }
  std::string operator()(std::map<std::string, std::string>* target) const {
    target->clear();
    if (node.IsNull()) return {};
    if (!node.IsMap()) return "has no names with values";
    if (node.size() > kMaxListLength) return "is too long";
    for (const auto& entry : node) {
      const bool text = entry.first.IsScalar() && !entry.first.Scalar().empty() &&
                        entry.second.IsScalar() && !entry.second.Scalar().empty();
      if (!text) return "has a name or a value that is not text or a number";
      if (!target->emplace(entry.first.Scalar(), entry.second.Scalar()).second) {
        return fmt::format("has {} twice", shown(entry.first.Scalar()));
      }
    }
    return {};
  }
  std::string operator()(SourceKind* target) const {
    const std::string kind = node.IsScalar() ? node.Scalar() : "";
    if (kind == "simulator") {
      *target = SourceKind::kSimulator;
    } else if (kind == "files") {
      *target = SourceKind::kFiles;
    } else if (kind == "camera") {
      *target = SourceKind::kCamera;
    } else {
      return "is no source";
    }
    return {};
  }

 private:
  // False for NaN as well.
  bool in_range(double value) const { return value >= field.min && value <= field.max; }
};

class Reader {
 public:
  explicit Reader(std::string name) { loaded_.name = std::move(name); }

  void read_document(std::string_view text) {
    const YAML::Node document = parse(std::string(text), loaded_.name);
    if (document.IsNull()) return;
    read_section(document, "");
  }

  void read_override(const std::string& assignment) {
    const std::string name = fmt::format("--set {}", shown_key(assignment));
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos) {
      throw ConfigError(fmt::format("{}: no value; accepted: KEY=VALUE", name));
    }
    const std::string key = assignment.substr(0, equals);
    const Field* field = find_field(key);
    if (field == nullptr) {
      const std::string section = key.substr(0, key.find('.'));
      throw unknown_key(name, key, is_section(section) ? section : "");
    }
    const YAML::Node value = parse(assignment.substr(equals + 1), name);
    read_value(*field, value, name);
  }

  LoadedConfiguration finish() {
    const Configuration& c = loaded_.values;
    if (c.source == SourceKind::kFiles && c.files.paths.empty()) {
      throw loaded_.error("files.paths",
                          "is empty, but source is files; accepted: at least one "
                          "image, folder of images or .y4m file");
    }
    if (c.detector.min_diameter_px > c.detector.max_diameter_px) {
      throw loaded_.error("detector.min_diameter_px",
                          fmt::format("{} is more than max_diameter_px; accepted: at most {}",
                                      c.detector.min_diameter_px, c.detector.max_diameter_px));
    }
    if ((c.camera.crop_width == 0) != (c.camera.crop_height == 0)) {
      throw loaded_.error("camera.crop_width",
                          "and camera.crop_height go together; accepted: both 0 (no crop), or both "
                          "more");
    }
    const auto web = parse_web_address(c.control.web);
    if (web && !web->loopback && c.control.token.empty()) {
      throw loaded_.error("control.web",
                          fmt::format("{} can be reached by others; accepted: only together with a "
                                      "control.token, or an address of this machine alone, as in "
                                      "127.0.0.1:8080",
                                      c.control.web));
    }
    loaded_.values.detector.response = ResponseCurve::named(c.camera.response);
    return std::move(loaded_);
  }

 private:
  static YAML::Node parse(const std::string& text, const std::string& name) {
    YamlLimits limits;
    limits.bytes = kMaxBytes;
    try {
      return parse_bounded_yaml(text, name, limits);
    } catch (const std::runtime_error& error) {
      throw ConfigError(error.what());
    }
  }

  void read_section(const YAML::Node& section, const std::string& prefix) {
    if (!section.IsMap()) {
      throw ConfigError(fmt::format("{}: {}{}is not a section; accepted: keys {}",
                                    where(loaded_.name, section.Mark()), prefix,
                                    prefix.empty() ? "" : ": ", keys_of_section(prefix)));
    }
    for (const auto& entry : section) {
      const YAML::Node &key_node = entry.first, &value = entry.second;
      const std::string place = where(loaded_.name, key_node.Mark());
      if (!key_node.IsScalar() || key_node.Scalar().find('.') != std::string::npos) {
        throw ConfigError(fmt::format("{}: {}a key must be a word without dots; accepted: {}",
                                      place, prefix.empty() ? "" : prefix + ": ",
                                      keys_of_section(prefix)));
      }
      const std::string key =
          prefix.empty() ? key_node.Scalar() : fmt::format("{}.{}", prefix, key_node.Scalar());
      if (!loaded_.origins.try_emplace(key, where(loaded_.name, value.Mark())).second) {
        throw ConfigError(fmt::format("{}: {}: is set twice", place, key));
      }
      const Field* field = find_field(key);
      if (field != nullptr) {
        read_value(*field, value, where(loaded_.name, value.Mark()));
      } else if (!is_section(key)) {
        throw unknown_key(place, key, prefix);
      } else if (!value.IsNull()) {
        read_section(value, key);
      }
    }
  }

  void read_value(const Field& field, const YAML::Node& node, const std::string& place) {
    const FieldTarget target = field.target(loaded_.values);
    std::string problem = std::visit(ReadValue{field, node}, target);
    if (problem.empty() && field.rule != nullptr && !field.rule(target)) problem = "is not valid";
    if (!problem.empty()) {
      const std::string value = node.IsScalar()     ? shown(node.Scalar())
                                : node.IsNull()     ? "nothing"
                                : node.IsSequence() ? "the list"
                                                    : "the section";
      throw ConfigError(fmt::format("{}: {}: {} {}; accepted: {}", place, field.key, value, problem,
                                    accepted_values(field)));
    }
    loaded_.origins[std::string(field.key)] = place;
  }

  static ConfigError unknown_key(const std::string& place, const std::string& key,
                                 const std::string& section) {
    const std::string_view nearest = nearest_key(key);
    const std::string hint = nearest.empty() ? "" : fmt::format(" (did you mean {}?)", nearest);
    return ConfigError(fmt::format("{}: {}: unknown key{}; accepted: {}", place, shown_key(key),
                                   hint, keys_of_section(section)));
  }
  static std::string shown_key(const std::string& key) {
    const std::string quoted = shown(key);
    return quoted.substr(1, quoted.size() - 2);
  }

  LoadedConfiguration loaded_;
};

}  // namespace

ConfigError LoadedConfiguration::error(const std::string& key, std::string_view what) const {
  const auto origin = origins.find(key);
  return ConfigError(
      fmt::format("{}: {}: {}", origin == origins.end() ? name : origin->second, key, what));
}

LoadedConfiguration parse_configuration(std::string_view yaml, const std::string& name,
                                        std::span<const std::string> overrides) {
  Reader reader(name);
  reader.read_document(yaml);
  for (const std::string& assignment : overrides) reader.read_override(assignment);
  return reader.finish();
}

LoadedConfiguration read_configuration(const std::string& path,
                                       std::span<const std::string> overrides) {
  std::string text;
  try {
    text = read_text_file(path, kMaxBytes);
  } catch (const std::runtime_error& error) {
    throw ConfigError(error.what());
  }
  // A full disk or an editor at work leaves such files: nobody wants the simulator for it.
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw ConfigError(fmt::format(
        "{}: is empty; a file with nothing but a comment (#) stands for the defaults", path));
  }
  return parse_configuration(text, path, overrides);
}

LoadedConfiguration default_configuration(std::span<const std::string> overrides) {
  return parse_configuration(default_yaml(), "the built-in configuration", overrides);
}

}  // namespace roundel
