#pragma once

#include "core/grey_image.hpp"
#include "tests/lab/usb_descriptors.hpp"

namespace roundel {

// A grey picture as the bytes of a format; colourless.
UsbBytes encode_picture(const GreyImage& picture, UsbFormat format);

}  // namespace roundel
