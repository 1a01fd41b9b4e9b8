#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "config/reader.hpp"
#include "core/tracker.hpp"
#include "daemon/arena_stage.hpp"
#include "daemon/broadcast.hpp"
#include "daemon/control/control_center.hpp"
#include "daemon/frame_source.hpp"
#include "daemon/monotonic_timer.hpp"
#include "daemon/service/service_report.hpp"
#include "daemon/service/service_status.hpp"
#include "daemon/signal_descriptor.hpp"
#include "daemon/statistics.hpp"

namespace roundel {

// roundeld without its command line: carries frames from the source to the network on one thread,
// until a signal or the end of a recording.
class Daemon final : private LoopControl {
 public:
  // Reads the configuration; called again for every reload.
  using Load = std::function<LoadedConfiguration()>;

  // Sets everything up. Throws ConfigError, or std::runtime_error where a file is at fault.
  Daemon(Load load, SignalDescriptor& signals, std::unique_ptr<ServiceLink> service);

  // Returns the exit status: 0, or 1 if parts of a recording could not be read.
  int run();

 private:
  // What follows from a configuration. A reload replaces only what has changed.
  struct Parts {
    LoadedConfiguration configuration;
    std::unique_ptr<FrameSource> source;
    std::optional<CameraModel> camera;
    std::optional<Tracker> tracker;
    std::optional<Broadcast> broadcast;
  };

  void start(Parts parts);
  Configuration configuration() override { return parts_.configuration.values; }
  std::string reload() override;
  std::string try_to_reload();
  void set_arena(std::shared_ptr<const ArenaCalibration> calibration) override;
  void set_arena_moved(bool moved) override;
  std::shared_ptr<CameraControls> camera_controls() override;
  void start_recording(std::shared_ptr<RecordingQueue> queue, bool restart) override;
  void begin_session();
  void log_summary() const;
  void report_state();

  struct Wakeup {
    bool signal = false, status = false, command = false, frame = false;
  };
  Wakeup wait();
  bool carry_frame();  // false at the end of the source
  void take_state();
  void fit_tracker(int width, int height);
  void load_arena_file();
  void fit_arena();
  void fill(FrameSnapshot& snapshot, std::span<const Marker> markers,
            std::span<const ArenaPose> arena, const LumaView* picture);
  void record(const LumaView& luma, std::span<const Marker> markers,
              std::span<const ArenaPose> arena);
  void publish_status();
  DropCounts drops_of_session() const;
  void tell_service_manager();

  Load load_;
  SignalDescriptor& signals_;
  MonotonicTimer status_timer_;
  std::int64_t status_due_ns_ = 0;
  Parts parts_;
  Statistics statistics_;
  FrameInformation information_;  // of the last frame; the states hold in between
  status_t status_{};             // reused, so that its texts are not copied every second
  DropCounts drops_before_session_;
  DropCounts withheld_;  // tracked, but too old by then; of this session
  std::int64_t unsent_before_session_ = 0;
  bool told_of_other_resolution_ = false, told_of_most_markers_ = false;
  bool summary_due_ = false;
  bool frame_carried_ = false;  // since the service manager was told

  ServiceReport service_;
  SteadyRate service_rate_;
  fmt::memory_buffer service_text_;
  std::string reload_error_;  // of the last reload

  std::string arena_file_;  // that was read
  std::string arena_file_problem_;
  std::shared_ptr<const ArenaCalibration> arena_calibration_;
  std::string told_arena_problem_;
  ArenaStage arena_;
  std::shared_ptr<RecordingQueue> recording_;  // while somebody records
  ControlCenter control_;                      // last: its threads end first
};

}  // namespace roundel
