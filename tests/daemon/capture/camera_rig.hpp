#pragma once

#include <doctest/doctest.h>

#include <optional>

#include "daemon/capture/camera_source.hpp"
#include "tests/daemon/capture/fake_camera.hpp"
#include "tests/daemon/wait_for_descriptor.hpp"

// Looking after a CameraSource on a FakeCamera, as roundeld's loop does.
namespace roundel {

inline constexpr int kTimeoutMs = 10'000;

inline std::optional<FrameLease> wait_for_frame(CameraSource& source) {
  for (int i = 0; i < 50; ++i) {
    if (!wait_for_descriptor(source.descriptor(), kTimeoutMs)) return std::nullopt;
    if (std::optional<FrameLease> lease = source.next()) return lease;
  }
  return std::nullopt;
}

// Opens the camera; no frame has been delivered.
inline void open(CameraSource& source, const FakeCamera& camera) {
  const int starts = camera.state().starts;
  while (camera.state().starts == starts) {
    REQUIRE(wait_for_descriptor(source.descriptor(), kTimeoutMs));
    REQUIRE_FALSE(source.next().has_value());
  }
}

// Opens the camera, and takes its first frame.
inline void stream(CameraSource& source, FakeCamera& camera) {
  open(source, camera);
  camera.deliver({.sequence = 0});
  REQUIRE(wait_for_frame(source).has_value());
}

// Looks after the source until its camera is in a state.
inline bool reaches(CameraSource& source, CameraState state) {
  for (int i = 0; i < 50 && source.state() != state; ++i) {
    if (!wait_for_descriptor(source.descriptor(), kTimeoutMs)) return false;
    source.next();
  }
  return source.state() == state;
}

}  // namespace roundel
