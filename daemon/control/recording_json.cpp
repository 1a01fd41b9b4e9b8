#include "daemon/control/recording_json.hpp"

#include "calibration/arena_file.hpp"
#include "calibration/camera_file.hpp"
#include "config/writer.hpp"
#include "daemon/control/state_json.hpp"

namespace roundel {

using Json = nlohmann::ordered_json;

Json recording_json(const FrameSnapshot& frame, const Configuration& configuration,
                    double frame_rate, bool restart) {
  const TrackingContext& context = *frame.context;
  Json json = {{"recording", 1},
               {"version", ROUNDEL_VERSION},
               {"frame_rate", frame_rate},
               {"restarted", restart},
               {"configuration", configuration_yaml(configuration)}};
  if (context.camera) {
    json["camera"] = format_camera_file({context.camera_name, *context.camera});
  }
  if (context.arena_in_use()) json["arena"] = format_arena_file(*context.calibration);
  return json;
}

Json recorded_frame_json(const RecordingQueue::Entry& entry) {
  const FrameInformation& information = entry.frame.information;
  Json json = markers_json(entry.frame);
  json["mono"] = information.captured.mono_us;
  json["dropped"] = information.dropped;
  json["unrecorded"] = entry.unrecorded;
  json["width"] = entry.frame.picture.width;
  json["height"] = entry.frame.picture.height;
  return json;
}

}  // namespace roundel
