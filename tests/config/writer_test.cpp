#include "config/writer.hpp"

#include <doctest/doctest.h>

#include "config/default_yaml.hpp"
#include "config/fields.hpp"
#include "config/reader.hpp"

using namespace roundel;

namespace {

Configuration again(const Configuration& configuration) {
  return parse_configuration(configuration_yaml(configuration), "written").values;
}

}  // namespace

TEST_CASE("a configuration that is written reads back the same, every key of it") {
  const Configuration defaults = default_configuration().values;
  CHECK(changed_keys(again(defaults), defaults).empty());

  const std::vector<std::string> overrides = {
      "source=files",
      "files.paths=[\"a b.y4m\", \"7\", \"c: d, e\"]",
      "files.frame_rate=29.97",
      "camera.name='a \"quoted\" name: # no comment'",
      "camera.controls={gain: 20, auto_exposure: Manual Mode}",
      "camera.response=srgb",
      "marker.diameter=0.1",
      "marker.mounts=[7 height=0.12]",
      "simulator.clutter=false",
      "lcm.copies=[\"udpm://10.0.0.1:7667\"]",
      "control.socket="};
  const Configuration changed = default_configuration(overrides).values;
  CHECK(changed_keys(again(changed), changed).empty());
  CHECK(changed_keys(again(changed), defaults).size() == overrides.size());
}

TEST_CASE("a token stays where it is") {
  const std::vector<std::string> overrides = {"control.web=0.0.0.0:8080",
                                              "control.token=0123456789abcdef"};
  const Configuration configuration = default_configuration(overrides).values;
  CHECK(configuration_yaml(configuration).find("0123456789abcdef") == std::string::npos);
  CHECK(changed_keys(again(configuration), configuration) ==
        std::vector<std::string_view>{"control.token"});
}
