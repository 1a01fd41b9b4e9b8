#pragma once

#include <string>
#include <vector>

#include "calibration/view_collector.hpp"

namespace roundel {

// Guidance for somebody who holds a board before a camera, on standard error: a line for every view
// that is taken, with what to show next. On a terminal besides, a line that changes in place says
// what is wrong with what the camera sees now, and the bell rings for every view, because whoever
// holds the board can't always see the screen.
class CollectionProgress {
 public:
  CollectionProgress();
  ~CollectionProgress();
  CollectionProgress(const CollectionProgress&) = delete;
  CollectionProgress& operator=(const CollectionProgress&) = delete;

  // What became of a frame, with the collector after it.
  void show(ViewCollector::Outcome outcome, const ViewCollector& collector);
  // Why there is no frame.
  void show_trouble(const std::string& what);

 private:
  void say(const std::string& line);    // for good
  void flash(const std::string& line);  // until the next

  bool terminal_ = false, flashing_ = false;
  std::string last_;
  std::vector<std::string> told_;  // advice
};

}  // namespace roundel
