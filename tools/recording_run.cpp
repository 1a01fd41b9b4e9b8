#include "tools/recording_run.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <optional>
#include <stdexcept>

#include "tools/recording_folder.hpp"
#include "tools/recording_reader.hpp"
#include "transport/clock.hpp"

namespace roundel {
namespace {

// What a recording turned out to be, beside its frames.
struct Outcome {
  std::int64_t unrecorded = 0;
  std::int64_t session = 0;  // of the first frame
  std::optional<std::int64_t> other_session_from;
  std::int64_t first_us = 0, last_us = 0;  // of capture
  std::int64_t begun_mono_us = 0;          // when the first frame came
};

void note(Outcome& outcome, const RecordingReader::Frame& frame, std::int64_t frames) {
  if (frames == 1) {
    outcome.session = frame.session;
    outcome.first_us = frame.utime;
    outcome.begun_mono_us = now().mono_us;
  }
  outcome.last_us = frame.utime;
  outcome.unrecorded = frame.unrecorded;
  if (frame.session != outcome.session && !outcome.other_session_from) {
    outcome.other_session_from = frame.number;
  }
}

std::string text_of(const std::string& path, const RecordingFolder& folder,
                    const Outcome& outcome) {
  std::string text = fmt::format("{}: {} frames in {:.1f} s, {:.1f} MB\n", path, folder.frames(),
                                 static_cast<double>(outcome.last_us - outcome.first_us) / 1e6,
                                 static_cast<double>(folder.bytes()) / 1e6);
  if (outcome.unrecorded > 0) {
    text += fmt::format(
        "{} frames are missing, because the disk or this machine was too slow; from the first of "
        "them on, a replay may give slightly other poses\n",
        outcome.unrecorded);
  }
  if (outcome.other_session_from) {
    text +=
        fmt::format("roundeld took other settings at frame {}; replay.yaml has those from before\n",
                    *outcome.other_session_from);
  }
  return text;
}

// A client that has just gone is noticed by roundeld with its next frames.
void stream_when_free(const ControlClient& client, const std::string& path,
                      const std::function<bool(std::string_view)>& take,
                      const std::function<bool()>& go_on) {
  constexpr long kConflict = 409;
  constexpr int kTries = 20, kPauseMs = 100;
  for (int attempt = 1;; ++attempt) {
    try {
      client.stream(path, take, go_on);
      return;
    } catch (const ControlError& error) {
      if (error.status() != kConflict || attempt == kTries || !go_on()) throw;
      ::poll(nullptr, 0, kPauseMs);
    }
  }
}

}  // namespace

std::string run_recording(const ControlClient& client, const std::string& path,
                          const RecordingLimits& limits, const std::function<bool()>& go_on) {
  std::optional<RecordingFolder> folder;
  Outcome outcome;
  const auto is_full = [&] { return folder && folder->frames() == limits.frames; };
  RecordingReader reader(
      [&](const nlohmann::ordered_json& heading) { folder.emplace(path, heading); },
      [&](const RecordingReader::Frame& frame) {
        if (is_full()) return;  // in the same piece as the last one
        folder->add(frame);
        note(outcome, frame, folder->frames());
      });
  // From the first frame on.
  const auto is_over = [&] {
    return folder && folder->frames() > 0 &&
           static_cast<double>(now().mono_us - outcome.begun_mono_us) >= 1e6 * limits.seconds;
  };
  const std::function<bool()> is_wanted = [&] { return go_on() && !is_over() && !is_full(); };
  try {
    stream_when_free(
        client, limits.keep_tracks ? "/v1/recording?restart=0" : "/v1/recording",
        [&](std::string_view piece) {
          reader.take(piece);
          return is_wanted();
        },
        is_wanted);
    if (folder) folder->close();
  } catch (const std::exception&) {
    if (folder && folder->frames() > 0) fmt::print(stderr, "{}", text_of(path, *folder, outcome));
    throw;
  }
  if (!folder || folder->frames() == 0) throw std::runtime_error("no frame came from roundeld");
  return text_of(path, *folder, outcome);
}

}  // namespace roundel
