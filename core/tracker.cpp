#include "core/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/frame_check.hpp"
#include "core/marker_search.hpp"
#include "core/track.hpp"

namespace roundel {

namespace {

constexpr int kMaxMissed = 30;       // frames; then a track ends
constexpr int kMaxImplausible = 15;  // frames; a blurred or half covered marker recovers
constexpr int kNewcomerFrames = 5;   // a full search is spread over as many frames
// How often a settled track is read and weighed anew, and how often the slope of the light and the
// blur by motion, which change slowly, are fitted along; frames.
constexpr int kReadingInterval = 64, kLightInterval = 8;
// Where the evidence leaves the pose undecided, it is weighed in every frame at first, then every
// few.
constexpr int kFirstWeighings = 16;
constexpr std::int64_t kWeighingInterval = 4;
// Weighing costs several times what a fit does: a crowd's turns come so seldom that about as many
// are weighed in a frame.
constexpr std::int64_t kWeighingsAFrame = 64;
// What moves as it moved before is followed without a look at its outline; pixels.
constexpr double kMaxSurprise = 0.6;
// And so close to the expected place the first step of the fit is mostly the last one.
constexpr double kClose = 0.2;
constexpr double kLocalReach = 2.0;  // of the search around an expected place, in diameters
constexpr double kMaxGrowth = 1.8;   // of a marker's extent from frame to frame
constexpr double kSameSize = 1.6;    // ratio of sizes of one marker in neighbouring frames
constexpr double kSureReading = 0.99;
constexpr double kAnyTurn = 1.81;         // radians: standard deviation of a turn that may be any
constexpr std::size_t kWorthSharing = 8;  // tracks: waking a thread takes as long as a fit or two

double mean_radius(const Ellipse& e) {
  return std::sqrt(e.a * e.b);
}

bool similar_size(const Ellipse& a, const Ellipse& b) {
  const double ratio = mean_radius(a) / mean_radius(b);
  return ratio < kSameSize && ratio > 1 / kSameSize;
}

double distance(const Ellipse& a, const Ellipse& b) {
  return std::hypot(a.u - b.u, a.v - b.v);
}

// By how much a pose lies aside of another one, pixels of the outer edge; tilt left out.
double distance_px(const Pose& from, const Pose& to, double radius_m, double radius_px) {
  const Eigen::Quaterniond turn = from.orientation.conjugate() * to.orientation;
  // As seen: depth is less certain, and goes with a shift aside away from the axis.
  const Eigen::Vector2d seen_from = from.position.head<2>() / from.position.z();
  const Eigen::Vector2d seen_to = to.position.head<2>() / to.position.z();
  const double aside = (seen_to - seen_from).norm() * to.position.z() / radius_m;
  return (aside + 2 * std::abs(turn.z())) * radius_px;
}

// The camera's driver has just written the picture, mostly not into this processor's cache: what
// the next marker needs may be on its way while this one is worked on. Each row is read once, which
// brings its page's address along, without which hints are dropped; for the rest hints will do.
void prefetch(const LumaView& frame, const Ellipse& e) {
  constexpr std::ptrdiff_t kLine = 64;  // bytes
  const int reach = static_cast<int>(1.2 * e.a) + 1;
  const int u = static_cast<int>(e.u), v = static_cast<int>(e.v);
  const int u0 = std::max(0, u - reach), u1 = std::min(frame.width - 1, u + reach);
  const int v0 = std::max(0, v - reach), v1 = std::min(frame.height - 1, v + reach);
  if (u0 > u1) return;
  for (int row = v0; row <= v1; ++row) {
    static_cast<void>(
        *static_cast<const volatile std::uint8_t*>(frame.row(row) + u0 * frame.pixel_stride));
  }
  for (int row = v0; row <= v1; ++row) {
    const std::uint8_t* last = frame.row(row) + u1 * frame.pixel_stride;
    for (const std::uint8_t* at = frame.row(row) + u0 * frame.pixel_stride + kLine; at < last;
         at += kLine) {
      __builtin_prefetch(at);
    }
    __builtin_prefetch(last);
  }
}

// Whether an outline lies within the frame, a pixel to spare.
bool inside(const Ellipse& e, const LumaView& frame) {
  const double cosine = std::cos(e.angle), sine = std::sin(e.angle);
  const double half_u = std::hypot(e.a * cosine, e.b * sine) + 1;
  const double half_v = std::hypot(e.a * sine, e.b * cosine) + 1;
  return e.u >= half_u && e.v >= half_v && e.u + half_u <= frame.width - 1 &&
         e.v + half_v <= frame.height - 1;
}

}  // namespace

// To find a marker where its motion leads, before others' claims are looked at.
struct Attempt {
  Ellipse expected;
  std::optional<Observation> seen;
};

struct Tracker::Impl {
  Impl(const DetectorParameters& p, const std::optional<CameraModel>& camera)
      : parameters(p), search(p), observer(p, camera) {
    const auto usual = static_cast<std::size_t>(std::min(p.max_markers, 1024));
    tracks.reserve(usual);
    found.reserve(usual);
    markers.reserve(usual);
    attempts.resize(1);
  }

  void follow_tracks(const LumaView& frame);
  bool only_fitted(const Track& track) const;
  bool in_new_light(const Track& track) const;
  std::optional<Observation> fit(const LumaView& frame, const Track& track,
                                 const Expectation& expected, int worker = 0);
  Attempt follow_closely(const LumaView& frame, const Track& track, int worker);
  bool follow_side_by_side(const LumaView& frame);
  bool accept(const Attempt& attempt, const LumaView& frame);
  void search_for_lost(const LumaView& frame);
  bool follow(const LumaView& frame, const Track& track);
  Observation observe(const LumaView& frame, const Track& track);
  Attempt follow_disturbed(const LumaView& frame, const Track& track);
  void follow_with_care(const LumaView& frame, Track& track);
  void search_nearby(const LumaView& frame, const Track& track);
  void find_newcomers(const LumaView& frame);
  void exchange_mistaken();
  void adopt(const Observation& observation);
  Track* lost_track_for(const Observation& observation);
  void publish();

  DetectorParameters parameters;
  MarkerSearch search;
  Observer observer;
  std::vector<Track> tracks;  // by rising number
  std::vector<Segment> found;
  std::vector<Marker> markers;
  std::vector<Attempt> attempts;  // of all tracks where work is shared, else of one at a time
  std::shared_ptr<Workers> workers;
  std::int64_t next_number = 1;
  std::int64_t frames = 0;
  std::int64_t undecided = 0;  // tracks whose pose was not sure at the frame's start
  int band = 0;                // the part of the image searched for newcomers in this frame
  StageStopwatch::Clock clock = nullptr;
  StageTimes stage_times;
};

// From the expected place inward: where the ring should be, a dark pixel starts the fill.
bool Tracker::Impl::follow(const LumaView& frame, const Track& track) {
  const Ellipse expected = track.predicted();
  const auto levels = measure_levels(frame, expected, parameters.min_contrast);
  if (!levels) return false;
  constexpr double kRing = 0.8;
  const double cosine = std::cos(expected.angle), sine = std::sin(expected.angle);
  const int extent = static_cast<int>(kMaxGrowth * 2 * expected.a) + 4;
  // Half way between the levels; where the edge of a shadow crosses the marker, its shaded white
  // may be darker than that.
  for (const double height : {0.5, 0.25}) {
    const int threshold = static_cast<int>(std::lround(levels->dark + height * levels->contrast()));
    for (const double side : {-kRing, kRing}) {
      const int u = static_cast<int>(std::lround(expected.u + side * expected.a * cosine));
      const int v = static_cast<int>(std::lround(expected.v + side * expected.a * sine));
      if (!frame.contains(u, v) || search.is_claimed(u, v)) continue;
      if (search.examine(frame, u, v, threshold, {extent, extent}) == Verdict::kAccepted) {
        return similar_size(search.segment().ellipse, track.ellipse);
      }
    }
  }
  return false;
}

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

// Whether a track only has to be fitted, not read and weighed anew; which it is from time to time.
bool Tracker::Impl::only_fitted(const Track& track) const {
  if (!track.is_sure_of_name(observer.id_count())) return false;
  std::int64_t interval = kReadingInterval;
  if (!track.is_sure_of_pose()) {
    if (track.weighings < kFirstWeighings) return false;
    interval = std::max(kWeighingInterval, undecided / kWeighingsAFrame);
  }
  return (frames + track.number) % interval != 0;
}

bool Tracker::Impl::in_new_light(const Track& track) const {
  return (frames + track.number) % kLightInterval == 0;
}

// What a fit does not tell anew it takes from the track.
std::optional<Observation> Tracker::Impl::fit(const LumaView& frame, const Track& track,
                                              const Expectation& expected, int worker) {
  const auto& last = track.observation.poses[static_cast<std::size_t>(track.pose_index)];
  auto followed = observer.follow(frame, last, expected, worker);
  if (followed) {
    followed->surprise_px = distance_px(track.predicted_pose(), followed->poses[0].pose,
                                        parameters.diameter_m / 2, expected.ellipse.a);
    followed->id = track.observation.id;
    followed->id_probability = track.observation.id_probability;
  }
  return followed;
}

// A marker that moves as it did before is fitted where that leads, without a look for its outline.
Attempt Tracker::Impl::follow_closely(const LumaView& frame, const Track& track, int worker) {
  if (track.missed != 0 || track.observation.disturbed) return {};
  if (!(track.surprise_px < kMaxSurprise) || !only_fitted(track)) return {};
  Expectation expected;
  expected.pose = track.predicted_pose();
  const auto outline = observer.outline(expected.pose);
  if (!outline || !inside(*outline, frame)) return {};
  const auto levels = measure_levels(frame, *outline, parameters.min_contrast);
  if (!levels) return {};
  expected.ellipse = *outline;
  expected.levels = *levels;
  expected.in_new_light = in_new_light(track);
  expected.close = track.surprise_px < kClose;
  Attempt attempt{*outline, fit(frame, track, expected, worker)};
  if (attempt.seen && attempt.seen->surprise_px > kMaxSurprise) attempt.seen.reset();
  if (attempt.seen) {
    attempt.seen->segment.ellipse =
        observer.outline(attempt.seen->poses[0].pose).value_or(*outline);
  }
  return attempt;
}

// Two tracks never see one marker.
bool Tracker::Impl::accept(const Attempt& attempt, const LumaView& frame) {
  const Ellipse& expected = attempt.expected;
  if (!attempt.seen ||
      search.is_claimed(static_cast<int>(expected.u), static_cast<int>(expected.v))) {
    return false;
  }
  search.claim(attempt.seen->segment.ellipse, frame.height);
  return true;
}

// Makes all attempts by all workers, each by itself: what they find does not depend on who does it.
// False where there are too few to be worth it.
bool Tracker::Impl::follow_side_by_side(const LumaView& frame) {
  if (!workers || tracks.size() < kWorthSharing) return false;
  attempts.resize(tracks.size());
  struct Job {
    Impl* self;
    const LumaView* frame;
  } job{this, &frame};
  workers->run(
      [](void* context, int worker) {
        const auto [self, picture] = *static_cast<const Job*>(context);
        const auto stride = static_cast<std::size_t>(self->workers->count());
        for (auto i = static_cast<std::size_t>(worker); i < self->tracks.size(); i += stride) {
          self->attempts[i] = self->follow_closely(*picture, self->tracks[i], worker);
        }
      },
      &job);
  return true;
}

Observation Tracker::Impl::observe(const LumaView& frame, const Track& track) {
  const Segment& segment = search.segment();
  if (only_fitted(track)) {
    Expectation expected{track.predicted_pose(), segment.ellipse, segment.levels};
    expected.in_new_light = in_new_light(track);
    expected.pose.position =
        track.observation.poses[static_cast<std::size_t>(track.pose_index)].pose.position;
    const bool placed = observer.move(expected.pose, track.ellipse, segment.ellipse);
    if (auto followed = placed ? fit(frame, track, expected) : std::nullopt) {
      followed->segment = segment;
      return *followed;
    }
  }
  return observer.observe(frame, segment);
}

// What lies over a known marker, or a shadow's edge across it, hides its outline or its word. It is
// still where it should be, as far as most of it shows.
Attempt Tracker::Impl::follow_disturbed(const LumaView& frame, const Track& track) {
  if (!track.known_look) return {};
  const PoseHypothesis& last = track.observation.poses[static_cast<std::size_t>(track.pose_index)];
  Expectation expected;
  expected.pose = track.predicted_pose();
  if (!track.is_same_print(last)) expected.pose.orientation = track.known_look->pose.orientation;
  const auto outline = observer.outline(expected.pose);
  if (!outline || !inside(*outline, frame)) return {};
  expected.ellipse = *outline;
  expected.levels = measure_levels(frame, *outline, parameters.min_contrast)
                        .value_or(track.observation.segment.levels);
  Attempt attempt{*outline, observer.follow_disturbed(frame, *track.known_look, expected)};
  if (!attempt.seen) return attempt;
  Observation& seen = *attempt.seen;
  const IdEvidence::Name name = track.evidence.best(observer.id_count());
  if (seen.id > 0 &&
      seen.id != name.id) {  // what reads as another's word is not this one, half hidden
    attempt.seen.reset();
    return attempt;
  }
  if (seen.id < 1 && name.id > 0) {
    seen.id = name.id;
    seen.id_probability = 1.0 / observer.id_count();  // says nothing for or against
  }
  seen.surprise_px =
      distance_px(expected.pose, seen.poses[0].pose, parameters.diameter_m / 2, expected.ellipse.a);
  return attempt;
}

// A marker that is not simply where its motion leads: by its outline, or by what is seen of it.
void Tracker::Impl::follow_with_care(const LumaView& frame, Track& track) {
  const bool disturbed = track.observation.disturbed;
  if (disturbed) {
    if (const Attempt attempt = follow_disturbed(frame, track); accept(attempt, frame)) {
      track.update(*attempt.seen, observer.id_count());
      return;
    }
  }
  if (follow(frame, track)) {
    Observation seen = observe(frame, track);
    if (!disturbed && track.contradicts(seen, observer.id_count())) {
      if (const Attempt attempt = follow_disturbed(frame, track); attempt.seen)
        seen = *attempt.seen;
    }
    track.update(seen, observer.id_count());
  } else if (!disturbed) {
    if (const Attempt attempt = follow_disturbed(frame, track); accept(attempt, frame)) {
      track.update(*attempt.seen, observer.id_count());
    }
  }
}

void Tracker::Impl::follow_tracks(const LumaView& frame) {
  undecided = std::count_if(tracks.begin(), tracks.end(),
                            [](const Track& t) { return !t.is_sure_of_pose(); });
  const bool shared = follow_side_by_side(frame);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    Track& track = tracks[i];
    if (!shared && i + 1 < tracks.size()) prefetch(frame, tracks[i + 1].predicted());
    track.seen = false;
    if (track.missed != 0) continue;
    if (!shared) attempts.front() = follow_closely(frame, track, 0);
    const Attempt& attempt = attempts[shared ? i : 0];
    if (accept(attempt, frame)) {
      track.update(*attempt.seen, observer.id_count());
    } else {
      follow_with_care(frame, track);
    }
  }
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
  self.found.clear();
  StageStopwatch stopwatch(self.clock);
  self.follow_tracks(frame);
  self.stage_times.following_ns = stopwatch.lap_ns();
  self.search_for_lost(frame);
  self.find_newcomers(frame);
  self.stage_times.searching_ns = stopwatch.lap_ns();
  for (const Segment& segment : self.found) self.adopt(self.observer.observe(frame, segment));
  self.exchange_mistaken();
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
  impl_->band = 0;
}

}  // namespace roundel
