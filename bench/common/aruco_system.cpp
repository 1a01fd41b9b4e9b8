#include "bench/common/aruco_system.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/aruco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace roundel::bench {

namespace {

constexpr int kCells = 6;  // 4 x 4 bits and the border

// Half of the sub-pixel search's window in cells: it must not reach the next cell's corner
// (METHOD.md section 9, item 10). OpenCV's default is 5 px whatever the size. Of 0.3 to 0.9 cells
// of the shortest side this does best over all experiments.
constexpr double kWindowCells = 0.6;
constexpr int kMaxWindow = 15;  // pixels

cv::Ptr<cv::aruco::Dictionary> dictionary_for(const Experiment& experiment) {
  return cv::aruco::getPredefinedDictionary(experiment.markers <= 50 ? cv::aruco::DICT_4X4_50
                                                                     : cv::aruco::DICT_4X4_100);
}

std::vector<SquarePattern> patterns_for(const Experiment& experiment) {
  const auto dictionary = dictionary_for(experiment);
  std::vector<SquarePattern> patterns;
  for (int id = 0; id < dictionary->bytesList.rows; ++id) {
    cv::Mat image;
    dictionary->drawMarker(id, kCells, image);
    SquarePattern pattern;
    pattern.cells = kCells;
    for (int row = 0; row < kCells; ++row) {
      for (int column = 0; column < kCells; ++column) {
        pattern.white.push_back(image.at<std::uint8_t>(row, column) > 127);
      }
    }
    patterns.push_back(std::move(pattern));
  }
  return patterns;
}

using Corners = std::vector<cv::Point2f>;  // clockwise from the page's top left

// The same on the print itself, metres.
std::vector<cv::Point3f> printed_corners(double diameter_m) {
  const auto h = static_cast<float>(0.5 * diameter_m);
  return {{-h, h, 0}, {h, h, 0}, {h, -h, 0}, {-h, -h, 0}};
}

class ArucoSystem final : public System {
 public:
  ArucoSystem(const Experiment& experiment, bool sub_pixel)
      : experiment_(experiment),
        sub_pixel_(sub_pixel),
        name_(sub_pixel ? "aruco-subpix" : "aruco"),
        dictionary_(dictionary_for(experiment)),
        parameters_(cv::aruco::DetectorParameters::create()),
        object_(printed_corners(experiment.diameter_m)) {
    const CameraModel& c = experiment.camera;
    camera_ = (cv::Mat_<double>(3, 3) << c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1);
    const Distortion& d = c.distortion;
    lens_ = (cv::Mat_<double>(1, 5) << d.k1, d.k2, d.p1, d.p2, d.k3);
  }

  const std::string& name() const override { return name_; }
  int id_count() const override { return dictionary_->bytesList.rows; }

  std::span<const Sighting> look(const LumaView& picture) override {
    // OpenCV only reads its input, but a Mat has no const.
    const cv::Mat image(picture.height, picture.width, CV_8UC1,
                        const_cast<std::uint8_t*>(picture.data),
                        static_cast<std::size_t>(picture.row_stride));
    std::vector<Corners> corners;
    std::vector<int> ids;
    cv::aruco::detectMarkers(image, dictionary_, corners, ids, parameters_);
    sightings_.clear();
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (sub_pixel_) refine(image, corners[i]);
      sightings_.push_back(sighting_of(ids[i], corners[i]));
    }
    return sightings_;
  }

 private:
  static void refine(const cv::Mat& image, Corners& corners) {
    double side = cv::norm(corners[3] - corners[0]);
    for (std::size_t i = 0; i < 3; ++i)
      side = std::min(side, cv::norm(corners[i + 1] - corners[i]));
    const double cell = side / kCells;
    const int half = std::clamp(static_cast<int>(std::lround(kWindowCells * cell)), 1, kMaxWindow);
    cv::cornerSubPix(image, corners, cv::Size(half, half), cv::Size(-1, -1),
                     cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 0.001));
  }

  Sighting sighting_of(int id, const Corners& corners) const {
    std::vector<cv::Mat> turns, places;  // the better one of the two first
    cv::solvePnPGeneric(object_, corners, camera_, lens_, turns, places, false,
                        cv::SOLVEPNP_IPPE_SQUARE);
    cv::Mat r;
    cv::Rodrigues(turns.front(), r);
    Eigen::Matrix3d rotation;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) rotation(row, column) = r.at<double>(row, column);
    }
    const cv::Mat& t = places.front();
    Sighting sighting;
    sighting.number = id;
    sighting.pose.orientation = with_positive_w(Eigen::Quaterniond(rotation).normalized());
    sighting.pose.position = {t.at<double>(0), t.at<double>(1), t.at<double>(2)};
    const auto centre = experiment_.camera.project(sighting.pose.position);
    sighting.u = centre ? centre->x() : NAN;
    sighting.v = centre ? centre->y() : NAN;
    return sighting;
  }

  const Experiment& experiment_;
  bool sub_pixel_;
  std::string name_;
  cv::Ptr<cv::aruco::Dictionary> dictionary_;
  cv::Ptr<cv::aruco::DetectorParameters> parameters_;
  cv::Mat camera_, lens_;
  std::vector<cv::Point3f> object_;
  std::vector<Sighting> sightings_;
};

}  // namespace

std::vector<Contender> aruco_contenders() {
  return {{"aruco",
           [](const Experiment& experiment) {
             return square_print(experiment, patterns_for(experiment));
           },
           [](const Experiment& experiment) {
             Systems systems;
             systems.push_back(std::make_unique<ArucoSystem>(experiment, false));
             systems.push_back(std::make_unique<ArucoSystem>(experiment, true));
             return systems;
           }}};
}

Contender aruco_contender() {
  Contender contender = aruco_contenders().front();
  contender.systems = [](const Experiment& experiment) {
    cv::setNumThreads(1);
    Systems systems;
    systems.push_back(std::make_unique<ArucoSystem>(experiment, false));
    return systems;
  };
  return contender;
}

}  // namespace roundel::bench
