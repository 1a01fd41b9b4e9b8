#pragma once

#include <cstdint>
#include <vector>

#include "calibration/board.hpp"
#include "core/camera_model.hpp"
#include "core/pose.hpp"
#include "simulator/scene.hpp"
#include "simulator/truth.hpp"

namespace roundel {

// A board on its white sheet, for the simulator's Renderer.
Scene board_scene(const Board& board, const Pose& board_in_camera);

// Poses as somebody would show the board to the camera: all over the picture, tilted to all sides
// by up to 40 degrees and turned, near and far, never with less than two thirds of it in the
// picture. Deterministic.
std::vector<Pose> board_poses(const Board& board, const CameraModel& camera, int count,
                              std::uint64_t seed);

// What is true of the board's markers; the arena coordinates are those on the board.
FrameTruth board_truth(const Board& board, const CameraModel& camera, const Pose& board_in_camera);

}  // namespace roundel
