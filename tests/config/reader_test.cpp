#include "config/reader.hpp"

#include <doctest/doctest.h>

#include <random>
#include <string>
#include <vector>

#include "config/default_yaml.hpp"
#include "tests/error_of.hpp"
#include "tests/temporary_directory.hpp"

using namespace roundel;

namespace {

Configuration parse(const std::string& yaml, const std::vector<std::string>& overrides = {}) {
  return parse_configuration(yaml, "roundel.yaml", overrides).values;
}

std::string error_for(const std::string& yaml, const std::vector<std::string>& overrides = {}) {
  return error_of([&] { parse(yaml, overrides); });
}

}  // namespace

TEST_CASE("what is left out has its default") {
  CHECK(parse("").simulator.robots == 12);
  CHECK(parse("# nothing\n").lcm.channel == "ROUNDEL");
  CHECK(parse("simulator:\nlcm: {}\n").simulator.width == 1920);
}

TEST_CASE("an empty file is taken for one that was cut off, not for the defaults") {
  const TemporaryDirectory folder;
  for (const char* const text : {"", "\n \r\n"}) {
    const std::string path = folder.write("roundel.yaml", text);
    CHECK(error_of([&] { read_configuration(path, {}); }).starts_with(path + ": is empty"));
  }
  CHECK(read_configuration(folder.write("roundel.yaml", "# all as it is"), {})
            .values.simulator.robots == 12);
}

TEST_CASE("values of every type are read") {
  const Configuration c = parse(
      "source: files\n"
      "simulator: {robots: 30, noise: 1.5, corner_markers: false}\n"
      "files:\n  paths: [a.png, \"b c.y4m\"]\n  frame_rate: 0\n"
      "camera: {name: 7, calibration: }\n"
      "marker: {bits: 0}\n");
  CHECK(c.source == SourceKind::kFiles);
  CHECK(c.simulator.robots == 30);
  CHECK(c.simulator.noise == 1.5);
  CHECK_FALSE(c.simulator.corner_markers);
  CHECK(c.files.paths == std::vector<std::string>{"a.png", "b c.y4m"});
  CHECK(c.files.frame_rate == 0);
  CHECK(c.camera.name == "7");
  CHECK(c.camera.calibration.empty());
  CHECK(c.detector.bits == 0);
}

TEST_CASE("an unknown key is an error with its place, a suggestion and the known keys") {
  CHECK(error_for("source: simulator\nsimulator:\n  robot: 3\n") ==
        "roundel.yaml:3:3: simulator.robot: unknown key (did you mean simulator.robots?); "
        "accepted: width, height, frame_rate, robots, corner_markers, seed, noise, blur, exposure, "
        "clutter, arena_length, arena_width, camera_height");
  CHECK(error_for("diameter: 3\n")
            .starts_with("roundel.yaml:1:1: diameter: unknown key (did you mean marker.diameter?); "
                         "accepted: source, "));
  CHECK(error_for("xyzzy: 1\n").starts_with("roundel.yaml:1:1: xyzzy: unknown key; accepted: "));
  CHECK(error_for("simulator.robots: 3\n").find("without dots") != std::string::npos);
  CHECK(error_for("[a]: 3\n").find("a key must be a word") != std::string::npos);
}

TEST_CASE("a wrong type is an error with its place and what is accepted") {
  CHECK(error_for("simulator:\n  robots: many\n") ==
        "roundel.yaml:2:11: simulator.robots: \"many\" is not a whole number; accepted: a whole "
        "number from 0 to 500");
  CHECK(error_for("simulator: {robots: 3.5}\n").find("\"3.5\" is not a whole number") !=
        std::string::npos);
  CHECK(error_for("simulator: {robots: \"3\"}\n").find("not a whole number") != std::string::npos);
  CHECK(error_for("simulator: {robots: [3]}\n").find("the list is not a whole number") !=
        std::string::npos);
  CHECK(error_for("simulator: {robots: }\n").find("nothing is not a whole number") !=
        std::string::npos);
  CHECK(error_for("simulator: {noise: 3 m}\n").find("\"3 m\" is not a number") !=
        std::string::npos);
  CHECK(error_for("lcm: {per_marker: maybe}\n") ==
        "roundel.yaml:1:19: lcm.per_marker: \"maybe\" is not true or false; accepted: true, false");
  CHECK(error_for("files: {paths: a.png}\n") ==
        "roundel.yaml:1:16: files.paths: \"a.png\" is not a list; accepted: a list of text, as in "
        "[a.png, b.png]");
  CHECK(error_for("files: {paths: [[a]]}\n").find("an element that is not text") !=
        std::string::npos);
  CHECK(error_for("camera: {name: [a]}\n").find("is not text") != std::string::npos);
  CHECK(error_for("lcm: 3\n") ==
        "roundel.yaml:1:6: lcm: is not a section; accepted: keys url, interface, copies, "
        "channel, per_marker, max_datagram");
  CHECK(
      error_for("- a\n").starts_with("roundel.yaml:1:1: is not a section; accepted: keys source"));
  CHECK(error_for("source: {a: 1}\n")
            .find("the section is no source; accepted: simulator, files, camera") !=
        std::string::npos);
}

TEST_CASE("a value out of range is an error with its place and the range") {
  CHECK(
      error_for("simulator:\n  robots: -1\n") ==
      "roundel.yaml:2:11: simulator.robots: \"-1\" is out of range; accepted: a whole number from "
      "0 to 500");
  CHECK(error_for("simulator: {robots: 99999999999999999999}\n").find("out of range") !=
        std::string::npos);
  CHECK(error_for("simulator: {noise: .nan}\n").find("not a number") != std::string::npos);
  CHECK(error_for("simulator: {noise: nan}\n").find("out of range") != std::string::npos);
  CHECK(error_for("simulator: {noise: 1e999}\n").find("simulator.noise") != std::string::npos);
  CHECK(
      error_for("marker: {bits: 1}\n") ==
      "roundel.yaml:1:16: marker.bits: \"1\" is not valid; accepted: 0 (plain WhyCon markers), or "
      "2 to 16");
  CHECK(error_for("lcm: {max_datagram: 100}\n").find("from 512 to 65000") != std::string::npos);
  CHECK(error_for("lcm: {channel: \"A B\"}\n").find("accepted: 1 to 40 of the characters") !=
        std::string::npos);
  CHECK(error_for("lcm: {channel: \"\"}\n").find("has a wrong length") != std::string::npos);
  CHECK(error_for("camera: {name: \"a\\nb\"}\n").find("printable") != std::string::npos);
}

TEST_CASE("values that do not go together are an error") {
  CHECK(error_for("source: files\n") ==
        "roundel.yaml: files.paths: is empty, but source is files; accepted: at least one image, "
        "folder of images or .y4m file");
  CHECK(error_for("detector:\n  min_diameter_px: 50\n  max_diameter_px: 40\n") ==
        "roundel.yaml:2:20: detector.min_diameter_px: 50 is more than max_diameter_px; accepted: "
        "at most 40");
}

TEST_CASE("a camera is described by its place or its name, its mode and its controls") {
  const Configuration c = parse(
      "source: camera\n"
      "camera:\n"
      "  device: /dev/v4l/by-id/usb-x\n"
      "  format: YUYV\n"
      "  width: 1280\n"
      "  controls: {auto_exposure: Manual Mode, gain: 20, focus_automatic_continuous: false}\n");
  CHECK(c.source == SourceKind::kCamera);
  CHECK(c.camera.device == "/dev/v4l/by-id/usb-x");
  CHECK(c.camera.width == 1280);
  CHECK(c.camera.controls ==
        std::map<std::string, std::string>{{"auto_exposure", "Manual Mode"},
                                           {"gain", "20"},
                                           {"focus_automatic_continuous", "false"}});
  CHECK(parse("camera: {controls: }\n").camera.controls.empty());
  CHECK(parse("", {"camera.controls={gain: 3}"}).camera.controls.at("gain") == "3");
}

TEST_CASE("a camera that can't be meant is an error") {
  CHECK(error_for("camera: {device: video0}\n").find("accepted: a path, as in /dev/video0") !=
        std::string::npos);
  CHECK(error_for("camera: {controls: [gain]}\n").find("the list has no names with values") !=
        std::string::npos);
  CHECK(error_for("camera: {controls: {gain: [1]}}\n").find("not text or a number") !=
        std::string::npos);
  CHECK(error_for("camera: {controls: {gain: }}\n").find("not text or a number") !=
        std::string::npos);
  CHECK(error_for("camera: {controls: {gain: 1, gain: 2}}\n").find("gain\" twice") !=
        std::string::npos);
  CHECK(error_for("control: {web: \"0.0.0.0:80\"}\n").find("only together with a control.token") !=
        std::string::npos);
  CHECK(error_for("control: {web: \"localhost:80\"}\n").find("in numbers") != std::string::npos);
  CHECK(error_for("control: {web: \"127.0.0.1:80x\"}\n").find("in numbers") != std::string::npos);
  CHECK(error_for("control: {token: short}\n").find("16 to 128") != std::string::npos);
  CHECK(error_for("camera: {crop_width: 100}\n").find("camera.crop_height go together") !=
        std::string::npos);
}

TEST_CASE("a key that is set twice is an error") {
  CHECK(error_for("lcm: {channel: A}\nlcm: {url: x}\n") == "roundel.yaml:2:1: lcm: is set twice");
  CHECK(error_for("lcm:\n  channel: A\n  channel: B\n") ==
        "roundel.yaml:3:3: lcm.channel: is set twice");
}

TEST_CASE("overrides win over the file and are held to the same rules") {
  CHECK(parse("simulator: {robots: 3}\n", {"simulator.robots=4"}).simulator.robots == 4);
  CHECK(parse("", {"simulator.robots=4", "simulator.robots=5"}).simulator.robots == 5);
  CHECK(parse("", {"source=files", "files.paths=[a.png, b.png]"}).files.paths.size() == 2);
  CHECK(parse("", {"lcm.url=udpm://239.1.2.3:4?ttl=1"}).lcm.url == "udpm://239.1.2.3:4?ttl=1");
  CHECK(parse("", {"camera.calibration="}).camera.calibration.empty());
  CHECK(error_for("", {"simulator.robots=many"}) ==
        "--set simulator.robots=many: simulator.robots: \"many\" is not a whole number; "
        "accepted: a whole number from 0 to 500");
  CHECK(error_for("", {"simulator.robot=3"})
            .starts_with("--set simulator.robot=3: simulator.robot: unknown key (did you mean "
                         "simulator.robots?)"));
  CHECK(error_for("", {"simulator=3"}).find("unknown key") != std::string::npos);
  CHECK(error_for("", {"nonsense"}) == "--set nonsense: no value; accepted: KEY=VALUE");
  CHECK(error_for("", {"files.paths=[a"}).starts_with("--set files.paths=[a:1:"));
}

TEST_CASE("an error about a value can be raised later and still name the value's place") {
  const LoadedConfiguration loaded =
      parse_configuration("lcm:\n  url: bad\n", "roundel.yaml", std::vector<std::string>{});
  CHECK(std::string(loaded.error("lcm.url", "is no URL").what()) ==
        "roundel.yaml:2:8: lcm.url: is no URL");
  CHECK(std::string(loaded.error("lcm.channel", "is bad").what()) ==
        "roundel.yaml: lcm.channel: is bad");
}

TEST_CASE("broken, huge and deep YAML are errors") {
  CHECK(error_for("simulator: [1, 2\nlcm: 3\n").starts_with("roundel.yaml:2:"));
  CHECK(error_for(std::string(70000, '#')) ==
        "roundel.yaml: too large for such a file, at most 65536 bytes");
  CHECK(error_for(std::string(60000, '[')).find("nested deeper than 16") != std::string::npos);
  CHECK(error_for("lcm: &a {channel: X}\nother: *a\n").find("aliases") != std::string::npos);
  CHECK(error_of([] { read_configuration("/nonexistent.yaml"); }) ==
        "/nonexistent.yaml: can't be opened: No such file or directory");
}

TEST_CASE("a file is read with its name in the errors") {
  const TemporaryDirectory folder;
  const std::string good = folder.write("good.yaml", "simulator: {robots: 2}\n");
  CHECK(read_configuration(good).values.simulator.robots == 2);
  const std::string bad = folder.write("bad.yaml", "\nrobots: 2\n");
  CHECK(error_of([&] { read_configuration(bad); }).starts_with(bad + ":2:1: robots: unknown key"));
}

TEST_CASE("damaged configuration files are errors, never crashes") {
  const std::string sample(default_yaml());
  constexpr std::string_view kNasty = "{}[]:,-&*!|>'\"%@`#?\n\t 0.eE~<\\";
  std::mt19937 random(5);
  int refused = 0;
  for (int i = 0; i < 1500; ++i) {
    std::string text = sample;
    for (int change = 0; change < 4; ++change) {
      const std::size_t at = random() % text.size();
      if (random() % 2 == 0) {
        text[at] = kNasty[random() % kNasty.size()];
      } else {
        text.insert(at, 1, static_cast<char>(random() % 256));
      }
    }
    try {
      parse(text);
    } catch (const ConfigError& error) {
      REQUIRE(std::string(error.what()).starts_with("roundel.yaml"));
      ++refused;
    }
  }
  CHECK(refused > 100);
}
