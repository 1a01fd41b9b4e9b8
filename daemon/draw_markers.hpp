#pragma once

#include <cairo.h>

#include <optional>
#include <span>
#include <string>

#include "core/camera_model.hpp"
#include "core/luma_view.hpp"
#include "core/marker.hpp"
#include "daemon/cairo_pointer.hpp"

namespace roundel {

// Draws what was found over a picture whose pixel (0, 0) has its centre at cairo's (0.5, 0.5): the
// outline, the id, and, with a pose and a camera, the marker's axes: x red, y green, z blue, as
// long as its radius.
void draw_found_markers(cairo_t* context, std::span<const Marker> markers,
                        const std::optional<CameraModel>& camera, double diameter_m);

// A frame as a picture to draw on. Throws std::runtime_error if there is no memory for it.
CairoSurface grey_surface(const LumaView& frame);

// The frame in grey with what was found in colour. Throws std::runtime_error that names the file.
void save_annotated_png(const std::string& path, const LumaView& frame,
                        std::span<const Marker> markers, const std::optional<CameraModel>& camera,
                        double diameter_m);

}  // namespace roundel
