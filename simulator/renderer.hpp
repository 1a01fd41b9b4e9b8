#pragma once

#include <cstdint>
#include <memory>

#include "core/camera_model.hpp"
#include "core/grey_image.hpp"
#include "simulator/scene.hpp"

namespace roundel {

// Draws scenes as a camera would take them. The picture depends on the scene and the seed alone;
// what was drawn before only makes it faster, because pixels whose surroundings did not change are
// kept. Not thread-safe. No allocation once frames of a kind have been drawn.
class Renderer {
 public:
  // Throws std::invalid_argument for values out of range.
  Renderer(const CameraModel& camera, const Imaging& imaging);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  const CameraModel& camera() const;
  const Imaging& imaging() const;

  // Throws std::invalid_argument for a marker or shape that cannot exist (sizes, ratios, bits).
  void render(const Scene& scene, std::uint64_t noise_seed, GreyImage& out);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roundel
