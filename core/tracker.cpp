#include <algorithm>
#include <cmath>

#include "core/frame_check.hpp"
#include "core/tracker_impl.hpp"

namespace roundel {

namespace {

constexpr int kMaxMissed = 30;       // frames; then a track ends
constexpr int kMaxImplausible = 15;  // frames; a blurred or half covered marker recovers
constexpr int kNewcomerFrames = 5;   // a full search is spread over as many frames
constexpr double kLocalReach = 2.0;  // of the search around an expected place, in diameters
constexpr int kCurveTurns = 2;       // markers a frame that are asked for the camera's curve
constexpr int kAskings = 64;         // of followed markers
constexpr std::int64_t kAskingInterval = 16;
constexpr double kSureReading = 0.99;
constexpr double kAnyTurn = 1.81;  // radians: standard deviation of a turn that may be any

double distance(const Ellipse& a, const Ellipse& b) {
  return std::hypot(a.u - b.u, a.v - b.v);
}

}  // namespace

// The marker moved further than its own size allows to follow: a search around the expected place.
void Tracker::Impl::search_nearby(const LumaView& frame, const Track& track) {
  const Ellipse expected = track.predicted();
  const int reach = static_cast<int>(kLocalReach * 2 * expected.a) + 2;
  const int u = static_cast<int>(expected.u), v = static_cast<int>(expected.v);
  if (u + reach < 0 || v + reach < 0 || u - reach >= frame.width || v - reach >= frame.height) {
    return;
  }
  const Box area{u - reach, v - reach, u + reach, v + reach};
  const int spacing = std::max(search.smallest_spacing(), static_cast<int>(0.3 * expected.b));
  search.search(frame, area, spacing, static_cast<std::size_t>(parameters.max_markers), found);
}

// Only after every track that is where it should be has claimed its pixels.
void Tracker::Impl::search_for_lost(const LumaView& frame) {
  for (Track& track : tracks) {
    if (track.seen) continue;
    ++track.missed;
    search_nearby(frame, track);
  }
}

void Tracker::Impl::find_newcomers(const LumaView& frame) {
  // What was just lost may be anywhere; for what may come in, a part of the image a frame will do.
  const bool just_lost = std::any_of(tracks.begin(), tracks.end(),
                                     [](const Track& t) { return !t.seen && t.missed == 1; });
  const bool everything = tracks.empty() || just_lost;
  const int height = frame.height;
  Box area{0, 0, frame.width - 1, height - 1};
  if (!everything) {
    area.v0 = height * band / kNewcomerFrames;
    area.v1 = height * (band + 1) / kNewcomerFrames - 1;
    band = (band + 1) % kNewcomerFrames;
  }
  search.search(frame, area, search.smallest_spacing(),
                static_cast<std::size_t>(parameters.max_markers), found);
}

// A track that was not seen in this frame and that an observation may continue: the one with its
// id, else the nearest that does not have another id.
Track* Tracker::Impl::lost_track_for(const Observation& observation) {
  const Ellipse& here = observation.segment.ellipse;
  Track* best = nullptr;
  double best_distance = 0;
  bool best_named = false;
  for (Track& track : tracks) {
    if (track.seen || !similar_size(here, track.ellipse)) continue;
    const IdEvidence::Name name = track.evidence.best(observer.id_count());
    const bool known = name.id > 0 && name.probability >= parameters.min_id_probability;
    const bool sure = observation.id > 0 && observation.id_probability >= kSureReading;
    if (known && sure && name.id != observation.id) continue;
    const bool named = known && sure;
    const double away = distance(here, track.predicted());
    // An id may come back anywhere that it could have moved to; without one, only close by.
    const double reach = 2 * here.a * (named ? kLocalReach + 0.5 * track.missed : kLocalReach);
    if (away > reach && !(named && track.missed <= 2)) continue;
    if (!best || (named && !best_named) || (named == best_named && away < best_distance)) {
      best = &track;
      best_distance = away;
      best_named = named;
    }
  }
  return best;
}

void Tracker::Impl::adopt(const Observation& observation) {
  if (Track* track = lost_track_for(observation)) {
    track->update(observation, observer.id_count());
    return;
  }
  // A track may be blurred or half covered for a while; a newcomer has to look like a marker.
  if (!observation.convincing) return;
  if (tracks.size() >= static_cast<std::size_t>(parameters.max_markers)) return;
  Track& track = tracks.emplace_back();
  track.number = next_number++;
  track.ellipse = observation.segment.ellipse;
  track.update(observation, observer.id_count());
}

// Two robots that passed each other faster than the frames could follow: each track's reading then
// surely names the other's id, and the observations change places.
void Tracker::Impl::exchange_mistaken() {
  const int ids = observer.id_count();
  const auto mistaken = [&](const Track& track) {
    if (!track.seen || track.observation.id < 1) return false;
    const IdEvidence::Name name = track.evidence.best(ids);
    return name.id > 0 && name.id != track.observation.id &&
           track.observation.id_probability >= kSureReading;
  };
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (!mistaken(tracks[i])) continue;
    const int wanted = tracks[i].observation.id;
    for (std::size_t k = i + 1; k < tracks.size(); ++k) {
      if (!mistaken(tracks[k])) continue;
      if (tracks[k].evidence.best(ids).id != wanted) continue;
      if (tracks[k].observation.id != tracks[i].evidence.best(ids).id) continue;
      const Observation first = tracks[i].observation;
      tracks[i].update(tracks[k].observation, ids);
      tracks[k].update(first, ids);
      break;
    }
  }
}

// Until the camera's curve is known, followed markers are asked for it by turns: at first in every
// frame, then now and then, for where they are small or the picture is noisy there is no end to it.
void Tracker::Impl::ask_for_curve(const LumaView& frame) {
  if (askings > kAskings && frames % kAskingInterval != 0) return;
  const auto count = static_cast<std::int64_t>(tracks.size());
  for (std::int64_t k = 0; k < count; ++k) {
    const Track& track = tracks[static_cast<std::size_t>((frames + k) % count)];
    if (!track.seen || !track.observation.followed || track.observation.disturbed) continue;
    if (!observer.ask_for_curve(frame, track.observation)) return;
    askings = std::min(askings + 1, kAskings + 1);
  }
}

void Tracker::Impl::publish() {
  markers.clear();
  for (const Track& track : tracks) {
    if (!track.seen) continue;
    Marker marker = observer.to_marker(track.observation, track.pose_index);
    marker.track = track.number;
    const IdEvidence::Name name = track.evidence.best(observer.id_count());
    if (name.id > 0 && name.probability >= parameters.min_id_probability) {
      marker.id = name.id;
      marker.id_probability = name.probability;
    }
    if (marker.has_pose) marker.ambiguity = std::exp(-track.pose_log_odds);
    // The turn is that of another word than the one that the marker is known to wear.
    if (marker.has_pose && marker.id > 0 && track.observation.id > 0 &&
        track.observation.id != marker.id) {
      marker.sigma_rotation = (marker.sigma_rotation.array().square() +
                               (kAnyTurn * marker.pose.normal()).array().square())
                                  .sqrt();
    }
    markers.push_back(marker);
  }
}

Tracker::Tracker(const DetectorParameters& parameters, std::optional<CameraModel> camera)
    : impl_(std::make_unique<Impl>(parameters, camera)) {}
Tracker::~Tracker() = default;
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;

std::span<const Marker> Tracker::track(const LumaView& frame) {
  Impl& self = *impl_;
  check_frame(frame, self.observer.camera());
  ++self.frames;
  self.search.begin(frame);
  self.observer.limit_curve_turns(kCurveTurns);
  self.found.clear();
  StageStopwatch stopwatch(self.clock);
  self.follow_tracks(frame);
  self.stage_times.following_ns = stopwatch.lap_ns();
  self.search_for_lost(frame);
  self.find_newcomers(frame);
  self.stage_times.searching_ns = stopwatch.lap_ns();
  for (const Segment& segment : self.found) self.adopt(self.observer.observe(frame, segment));
  self.exchange_mistaken();
  self.ask_for_curve(frame);
  self.stage_times.identifying_ns = stopwatch.lap_ns();
  std::erase_if(self.tracks, [](const Track& track) {
    return track.missed > kMaxMissed || track.implausible > kMaxImplausible;
  });
  self.publish();
  self.observer.settle_curve();  // from the next frame on
  return self.markers;
}

void Tracker::share_work(std::shared_ptr<Workers> workers) {
  impl_->workers = std::move(workers);
  if (impl_->workers) impl_->observer.make_room_for(impl_->workers->count());
  impl_->attempts.reserve(impl_->workers ? impl_->tracks.capacity() : 1);
}

void Tracker::time_stages(StageStopwatch::Clock clock) {
  impl_->clock = clock;
  impl_->stage_times = {};
}

const StageTimes& Tracker::stage_times() const {
  return impl_->stage_times;
}

void Tracker::reset() {
  impl_->tracks.clear();
  impl_->observer.forget_curve();
  impl_->askings = 0;
  impl_->band = 0;
}

}  // namespace roundel
