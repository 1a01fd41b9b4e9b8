#pragma once

#include "transport/frame_encoder.hpp"
#include "transport/messages.hpp"

namespace roundel {

// Decode what came from the network. The generated decode() believes every length in a message and
// can be made to allocate without end; here lengths are checked against the message first. False
// means: not such a message, or damaged; `out` is unspecified then.
bool decode(Bytes message, frame_t& out);
bool decode(Bytes message, pose_t& out);
bool decode(Bytes message, status_t& out);

}  // namespace roundel
