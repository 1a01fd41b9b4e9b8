#include "bench/common/painter.hpp"
#include "bench/common/roundel_system.hpp"
#include "bench/speed/measure.hpp"
#include "bench/speed/stopwatch.hpp"
#include "core/tracker.hpp"
#include "transport/publisher.hpp"

namespace roundel::bench {

Timings time_publishing(const Experiment& experiment, const std::string& lcm_url) {
  constexpr int kWarmUp = 20;
  Painter painter(experiment, whycode_print(experiment));
  Tracker tracker(roundel_parameters(experiment, true), experiment.camera);
  Publisher publisher(open_sender(lcm_url), {.camera = "bench"});
  std::vector<double> publishing;
  GreyImage picture;
  for (int i = 0; i < std::ssize(experiment.views); ++i) {
    painter.paint(experiment.views[static_cast<std::size_t>(i)], picture);
    const auto markers = tracker.track(picture.view());
    FrameInformation frame;
    frame.frame = i;
    frame.width = picture.width;
    frame.height = picture.height;
    const double us = time_of([&] { publisher.publish(frame, markers); });
    if (i >= kWarmUp) publishing.push_back(us);
  }
  const bool sent = publisher.unsent_frames() == 0;
  return {{.scene = experiment.name,
           .system = "roundel",
           .frames = "poses to LCM",
           .width = experiment.camera.width,
           .markers = experiment.markers,
           .us = distribution_of(publishing),
           .count = static_cast<int>(publishing.size()),
           .seen = 1,
           .as_wanted = sent,
           .note = sent ? "all frames sent through " + lcm_url : "some frames could not be sent"}};
}

}  // namespace roundel::bench
