#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>

#include "tests/lab/film.hpp"

namespace roundel {

// The kernel's vivid driver with its HDMI output looped to its HDMI input: what is written to the
// one device comes out of the other, a camera that can be told to fail in many ways. Shows a film,
// every picture for two frames of its 60 a second. Only one at a time.
class VividCamera {
 public:
  // fourcc: GREY, or grey words with 10, 12 or 16 bits. Loads the driver with options of its own.
  VividCamera(const Film& film, std::uint32_t fourcc, const std::string& options = {});
  ~VividCamera();  // unloads it
  VividCamera(const VividCamera&) = delete;
  VividCamera& operator=(const VividCamera&) = delete;

  // Sets one of the driver's controls, by the name that v4l2-ctl has for it.
  void set(const std::string& control, int value) const;
  const std::string& node() const { return camera_; }

 private:
  // The driver, loaded.
  struct Module {
    explicit Module(const std::string& options);
    ~Module();
    Module(const Module&) = delete;
    Module& operator=(const Module&) = delete;
  };

  void set_up();
  void feed();

  Module module_;
  const Film& film_;
  std::uint32_t fourcc_;
  std::string camera_, output_;  // nodes
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace roundel
