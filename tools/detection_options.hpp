#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/configuration.hpp"
#include "core/camera_model.hpp"
#include "core/detector_parameters.hpp"

namespace roundel {

// The options that `detect` and `track` have in common.
struct DetectionOptions {
  std::vector<std::string> files;
  std::string camera_file;  // empty: no poses
  std::string arena_file;   // empty: no arena coordinates
  std::string arena_mode = "2d";
  MountSettings mount;
  std::string annotate;  // PNG file or directory; empty: no pictures
  bool json = false;
  DetectorParameters parameters;
};

// Adds them to the command; the result is filled by parsing.
std::shared_ptr<DetectionOptions> add_detection_options(CLI::App& command,
                                                        const std::string& files_help);

}  // namespace roundel
