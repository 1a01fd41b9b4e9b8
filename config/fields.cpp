#include "config/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "config/mounts.hpp"
#include "config/web_address.hpp"

namespace roundel {
namespace {

// The address of a member, as a function without state: FIELD(lcm.url).
#define ROUNDEL_TARGET(member) [](Configuration& c) -> FieldTarget { return &c.member; }

bool bits_exist(FieldTarget value) {
  return *std::get<int*>(value) != 1;
}

bool is_channel(FieldTarget value) {
  for (const char c : *std::get<std::string*>(value)) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '-' && c != '/') {
      return false;
    }
  }
  return true;
}

bool is_printable(FieldTarget value) {
  for (const char c : *std::get<std::string*>(value)) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) return false;
  }
  return true;
}

bool is_interface(FieldTarget value) {
  const std::string& name = *std::get<std::string*>(value);
  return std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isgraph(c) != 0 && c != '/' && c != ':'; });
}

bool is_response(FieldTarget value) {
  const std::string& name = *std::get<std::string*>(value);
  return name == "auto" || ResponseCurve::named(name);
}

bool is_inner_ratio(FieldTarget value) {
  const double ratio = *std::get<double*>(value);
  return ratio == 0 || ratio >= 0.2;
}

bool is_arena_mode(FieldTarget value) {
  const std::string& mode = *std::get<std::string*>(value);
  return mode == "2d" || mode == "3d";
}

bool are_mounts(FieldTarget value) {
  const auto& mounts = *std::get<std::vector<std::string>*>(value);
  return std::all_of(mounts.begin(), mounts.end(),
                     [](const std::string& text) { return parse_mount(text, {}).has_value(); });
}

bool is_path_or_empty(FieldTarget value) {
  const std::string& text = *std::get<std::string*>(value);
  return text.empty() || text.front() == '/';
}

bool is_web_address_or_empty(FieldTarget value) {
  const std::string& text = *std::get<std::string*>(value);
  return text.empty() || parse_web_address(text).has_value();
}

bool is_token_or_empty(FieldTarget value) {
  const std::string& text = *std::get<std::string*>(value);
  const auto fits = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.' || c == '~';
  };
  return text.empty() ||
         (text.size() >= kLeastToken && std::all_of(text.begin(), text.end(), fits));
}

constexpr std::array kFields = {
    Field{"source", ROUNDEL_TARGET(source)},

    Field{"simulator.width", ROUNDEL_TARGET(simulator.width), 64, 8192},
    Field{"simulator.height", ROUNDEL_TARGET(simulator.height), 64, 8192},
    Field{"simulator.frame_rate", ROUNDEL_TARGET(simulator.frame_rate), 0.1, 1000},
    Field{"simulator.robots", ROUNDEL_TARGET(simulator.robots), 0, 500},
    Field{"simulator.corner_markers", ROUNDEL_TARGET(simulator.corner_markers)},
    Field{"simulator.seed", ROUNDEL_TARGET(simulator.seed), 0, 2147483647},
    Field{"simulator.noise", ROUNDEL_TARGET(simulator.noise), 0, 60},
    Field{"simulator.blur", ROUNDEL_TARGET(simulator.blur), 0, 10},
    Field{"simulator.exposure", ROUNDEL_TARGET(simulator.exposure), 0, 0.1},
    Field{"simulator.clutter", ROUNDEL_TARGET(simulator.clutter)},
    Field{"simulator.arena_length", ROUNDEL_TARGET(simulator.arena_length), 0.1, 100},
    Field{"simulator.arena_width", ROUNDEL_TARGET(simulator.arena_width), 0.1, 100},
    Field{"simulator.camera_height", ROUNDEL_TARGET(simulator.camera_height), 0.1, 100},

    Field{"files.paths", ROUNDEL_TARGET(files.paths)},
    Field{"files.frame_rate", ROUNDEL_TARGET(files.frame_rate), 0, 1000},
    Field{"files.loop", ROUNDEL_TARGET(files.loop)},

    Field{"camera.name", ROUNDEL_TARGET(camera.name), 1, 64, is_printable,
          "text of 1 to 64 printable characters"},
    Field{"camera.calibration", ROUNDEL_TARGET(camera.calibration), 0, 4096},
    Field{"camera.response", ROUNDEL_TARGET(camera.response), 1, 20, is_response,
          "auto, linear, srgb, or a gamma from 0.2 to 5"},
    Field{"camera.device", ROUNDEL_TARGET(camera.device), 0, 4096, is_path_or_empty,
          "a path, as in /dev/video0 or /dev/v4l/by-id/..., or nothing"},
    Field{"camera.match_card", ROUNDEL_TARGET(camera.match_card), 0, 100},
    Field{"camera.match_bus", ROUNDEL_TARGET(camera.match_bus), 0, 100},
    Field{"camera.match_serial", ROUNDEL_TARGET(camera.match_serial), 0, 256},
    Field{"camera.format", ROUNDEL_TARGET(camera.format), 1, 7},
    Field{"camera.width", ROUNDEL_TARGET(camera.width), 0, 16384},
    Field{"camera.height", ROUNDEL_TARGET(camera.height), 0, 16384},
    Field{"camera.frame_rate", ROUNDEL_TARGET(camera.frame_rate), 0.1, 1000},
    Field{"camera.crop_left", ROUNDEL_TARGET(camera.crop_left), 0, 16384},
    Field{"camera.crop_top", ROUNDEL_TARGET(camera.crop_top), 0, 16384},
    Field{"camera.crop_width", ROUNDEL_TARGET(camera.crop_width), 0, 16384},
    Field{"camera.crop_height", ROUNDEL_TARGET(camera.crop_height), 0, 16384},
    Field{"camera.buffers", ROUNDEL_TARGET(camera.buffers), 2, 32},
    Field{"camera.timeout", ROUNDEL_TARGET(camera.timeout), 0.05, 60},
    Field{"camera.controls", ROUNDEL_TARGET(camera.controls)},

    Field{"marker.diameter", ROUNDEL_TARGET(detector.diameter_m), 0.001, 10},
    Field{"marker.bits", ROUNDEL_TARGET(detector.bits), 0, kMaxBits, bits_exist,
          "0 (plain WhyCon markers), or 2 to 16"},
    Field{"marker.hamming", ROUNDEL_TARGET(detector.hamming), 1, kMaxHamming},
    Field{"marker.inner_ratio", ROUNDEL_TARGET(detector.inner_ratio), 0, 0.7, is_inner_ratio,
          "0 (not known), or 0.2 to 0.7"},

    Field{"marker.height", ROUNDEL_TARGET(mount.height), 0, 10},
    Field{"marker.offset_x", ROUNDEL_TARGET(mount.offset_x), -10, 10},
    Field{"marker.offset_y", ROUNDEL_TARGET(mount.offset_y), -10, 10},
    Field{"marker.rotation", ROUNDEL_TARGET(mount.rotation), -6.3, 6.3},
    Field{"marker.mounts", ROUNDEL_TARGET(mount.mounts), 0, 0, are_mounts,
          "a list of ids with height, offset_x, offset_y or rotation, as in [7 height=0.12]"},

    Field{"arena.mode", ROUNDEL_TARGET(arena.mode), 2, 2, is_arena_mode, "2d, 3d"},
    Field{"arena.file", ROUNDEL_TARGET(arena.file), 1, 4000},
    Field{"arena.recalibrate", ROUNDEL_TARGET(arena.recalibrate)},

    Field{"detector.max_markers", ROUNDEL_TARGET(detector.max_markers), 1, 10000},
    Field{"detector.min_diameter_px", ROUNDEL_TARGET(detector.min_diameter_px), 6, 8192},
    Field{"detector.max_diameter_px", ROUNDEL_TARGET(detector.max_diameter_px), 6, 8192},
    Field{"detector.min_contrast", ROUNDEL_TARGET(detector.min_contrast), 5, 200},
    Field{"detector.circularity_tolerance", ROUNDEL_TARGET(detector.circularity_tolerance), 0, 1},
    Field{"detector.area_ratio_tolerance", ROUNDEL_TARGET(detector.area_ratio_tolerance), 0, 10},
    Field{"detector.concentricity_tolerance", ROUNDEL_TARGET(detector.concentricity_tolerance), 0,
          1},
    Field{"detector.concentricity_tolerance_px",
          ROUNDEL_TARGET(detector.concentricity_tolerance_px), 0, 100},
    Field{"detector.threads", ROUNDEL_TARGET(tracking_threads), 1, 16},
    Field{"detector.min_id_probability", ROUNDEL_TARGET(detector.min_id_probability), 0, 1},

    Field{"lcm.url", ROUNDEL_TARGET(lcm.url), 1, 1000},
    Field{"lcm.interface", ROUNDEL_TARGET(lcm.interface_name), 0, 15, is_interface,
          "the name of a network interface, as in wlan0 (ip link lists them), or nothing"},
    Field{"lcm.copies", ROUNDEL_TARGET(lcm.copies)},
    Field{"lcm.channel", ROUNDEL_TARGET(lcm.channel), 1, 40, is_channel,
          "1 to 40 of the characters A-Z a-z 0-9 _ - /"},
    Field{"lcm.per_marker", ROUNDEL_TARGET(lcm.per_marker)},
    Field{"lcm.max_datagram", ROUNDEL_TARGET(lcm.max_datagram), 512, 65000},

    Field{"control.socket", ROUNDEL_TARGET(control.socket), 0, 107},
    Field{"control.group", ROUNDEL_TARGET(control.group), 0, 32},
    Field{"control.web", ROUNDEL_TARGET(control.web), 0, 64, is_web_address_or_empty,
          "an address in numbers and a port, as in 127.0.0.1:8080 or \"[::1]:8080\" (with the "
          "quotes), or nothing"},
    Field{"control.token", ROUNDEL_TARGET(control.token), 0, 128, is_token_or_empty,
          "16 to 128 of the characters A-Z a-z 0-9 _ - . ~, or nothing"},
};

#undef ROUNDEL_TARGET

struct Words {
  const Field& field;
  std::string operator()(const bool*) const { return "true, false"; }
  std::string operator()(const int*) const {
    return fmt::format("a whole number from {} to {}", field.min, field.max);
  }
  std::string operator()(const double*) const {
    return fmt::format("a number from {} to {}", field.min, field.max);
  }
  std::string operator()(const std::string*) const {
    return fmt::format("text of {} to {} characters", field.min, field.max);
  }
  std::string operator()(const std::vector<std::string>*) const {
    return "a list of text, as in [a.png, b.png]";
  }
  std::string operator()(const std::map<std::string, std::string>*) const {
    return "names and values, as in {auto_exposure: Manual Mode, gain: 20}";
  }
  std::string operator()(const SourceKind*) const { return "simulator, files, camera"; }
};

}  // namespace

std::span<const Field> fields() {
  return kFields;
}

const Field* find_field(std::string_view key) {
  for (const Field& field : kFields) {
    if (field.key == key) return &field;
  }
  return nullptr;
}

bool is_section(std::string_view name) {
  for (const Field& field : kFields) {
    if (field.key.size() > name.size() && field.key.starts_with(name) &&
        field.key[name.size()] == '.') {
      return true;
    }
  }
  return false;
}

std::string accepted_values(const Field& field) {
  if (!field.accepted.empty()) return std::string(field.accepted);
  Configuration any;
  return std::visit(Words{field}, field.target(any));
}

std::vector<std::string_view> changed_keys(const Configuration& a, const Configuration& b) {
  Configuration first = a, second = b;  // targets are not const
  std::vector<std::string_view> keys;
  for (const Field& field : kFields) {
    const FieldTarget other = field.target(second);
    const bool same =
        std::visit([&](auto* value) { return *value == *std::get<decltype(value)>(other); },
                   field.target(first));
    if (!same) keys.push_back(field.key);
  }
  return keys;
}

}  // namespace roundel
