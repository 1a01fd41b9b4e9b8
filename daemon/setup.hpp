#pragma once

#include <memory>
#include <optional>
#include <string>

#include "config/reader.hpp"
#include "core/tracker.hpp"
#include "daemon/broadcast.hpp"
#include "daemon/capture/camera_source.hpp"
#include "daemon/frame_source.hpp"

namespace roundel {

// Makes the daemon's parts from a configuration. All throw ConfigError, naming the place of the
// key, where the configuration is at fault, and std::runtime_error where a file is.

// A camera is opened later, and waited for if it is not there.
std::unique_ptr<FrameSource> make_source(const LoadedConfiguration& configuration);

CameraParameters camera_parameters(const LoadedConfiguration& configuration);

// The lens that poses are computed with; nothing without a calibration. Refuses one that is not for
// the source's resolution.
std::optional<CameraModel> make_camera(const LoadedConfiguration& configuration,
                                       const FrameSource& source);

Tracker make_tracker(const LoadedConfiguration& configuration,
                     const std::optional<CameraModel>& camera);

Broadcast make_broadcast(const LoadedConfiguration& configuration);
// Finds the same mistakes without opening the network.
void check_broadcast(const LoadedConfiguration& configuration);

bool same_camera(const std::optional<CameraModel>& a, const std::optional<CameraModel>& b);

}  // namespace roundel
