#include "bench/common/roundel_system.hpp"

#include "core/detector.hpp"
#include "core/necklace.hpp"
#include "core/tracker.hpp"

namespace roundel::bench {

DetectorParameters roundel_parameters(const Experiment& experiment, bool with_code) {
  DetectorParameters parameters;
  parameters.diameter_m = experiment.diameter_m;
  parameters.bits = with_code ? experiment.bits : 0;
  if (experiment.response_known) {
    parameters.response = experiment.imaging.srgb ? ResponseCurve::srgb()
                                                  : ResponseCurve::power(experiment.imaging.gamma);
  }
  return parameters;
}

namespace {

class RoundelSystem : public System {
 public:
  RoundelSystem(const Experiment& experiment, bool with_code, bool follows)
      : name_(std::string(with_code ? "roundel" : "roundel-whycon") + (follows ? "-track" : "")),
        with_code_(with_code),
        follows_(follows),
        id_count_(NecklaceCode(experiment.bits, 1).id_count()) {}

  const std::string& name() const override { return name_; }
  bool has_yaw() const override { return with_code_; }
  bool follows() const override { return follows_; }
  int id_count() const override { return id_count_; }

 protected:
  std::span<const Sighting> sightings(std::span<const Marker> markers) {
    sightings_.clear();
    for (const Marker& marker : markers) {
      sightings_.push_back({.number = marker.id > 0 ? marker.id - 1 : -1,
                            .id_probability = marker.id_probability,
                            .u = marker.u,
                            .v = marker.v,
                            .pose = marker.pose,
                            .has_sigma = true,
                            .sigma_position = marker.sigma_position,
                            .sigma_rotation = marker.sigma_rotation,
                            .ambiguity = marker.ambiguity});
    }
    return sightings_;
  }

 private:
  std::string name_;
  bool with_code_, follows_;
  int id_count_;
  std::vector<Sighting> sightings_;
};

class RoundelDetector final : public RoundelSystem {
 public:
  RoundelDetector(const Experiment& experiment, bool with_code)
      : RoundelSystem(experiment, with_code, false),
        detector_(roundel_parameters(experiment, with_code), experiment.camera) {}

  std::span<const Sighting> look(const LumaView& picture) override {
    return sightings(detector_.detect(picture));
  }

 private:
  Detector detector_;
};

class RoundelTracker final : public RoundelSystem {
 public:
  RoundelTracker(const Experiment& experiment, bool with_code)
      : RoundelSystem(experiment, with_code, true),
        tracker_(roundel_parameters(experiment, with_code), experiment.camera) {}

  std::span<const Sighting> look(const LumaView& picture) override {
    return sightings(tracker_.track(picture));
  }

 private:
  Tracker tracker_;
};

Systems systems_for(const Experiment& experiment, bool with_code) {
  Systems systems;
  systems.push_back(std::make_unique<RoundelDetector>(experiment, with_code));
  if (experiment.continuous) {
    systems.push_back(std::make_unique<RoundelTracker>(experiment, with_code));
  }
  return systems;
}

}  // namespace

std::vector<Contender> roundel_contenders() {
  return {{"roundel", whycode_print,
           [](const Experiment& experiment) { return systems_for(experiment, true); }},
          {"roundel-whycon", whycon_print,
           [](const Experiment& experiment) { return systems_for(experiment, false); }}};
}

}  // namespace roundel::bench
