#pragma once

#include <Eigen/Core>
#include <vector>

namespace roundel {

// The image of one marker's centre (not of its ellipse's) in a view of the board.
struct BoardPoint {
  int id = 0;
  Eigen::Vector2d on_board = Eigen::Vector2d::Zero();  // metres, board frame
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  // By the picture's noise alone; pixels squared, positive definite.
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
};

// What one picture of the board shows; every id at most once.
struct BoardView {
  int picture = 0;  // the caller's number of it
  std::vector<BoardPoint> points;
};

// Fewer points tell too little about a view of a flat board.
inline constexpr std::size_t kMinBoardPoints = 6;

}  // namespace roundel
