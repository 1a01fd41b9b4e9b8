#include "transport/messages.hpp"

#include <doctest/doctest.h>

#include "tests/sample_markers.hpp"

using namespace roundel;

TEST_CASE("a marker on the wire takes at most 200 bytes") {
  CHECK(marker_t()._getEncodedSizeNoHash() <= 200);
}

TEST_CASE("a marker survives the way over the wire in all fields") {
  const Marker sent = sample_marker(3);
  const Marker received = from_message(to_message(sent));
  CHECK(received.id == sent.id);
  CHECK(received.id_probability == doctest::Approx(sent.id_probability));
  CHECK(received.track == sent.track);
  CHECK(received.u == sent.u);
  CHECK(received.v == sent.v);
  CHECK(received.ellipse.u == sent.ellipse.u);
  CHECK(received.ellipse.v == sent.ellipse.v);
  CHECK(received.ellipse.a == sent.ellipse.a);
  CHECK(received.ellipse.b == sent.ellipse.b);
  CHECK(received.ellipse.angle == sent.ellipse.angle);
  CHECK(received.has_pose);
  CHECK(received.pose.position == sent.pose.position);
  CHECK(received.pose.orientation.coeffs() == sent.pose.orientation.coeffs());
  CHECK(received.sigma_position == sent.sigma_position);
  CHECK(received.sigma_rotation == sent.sigma_rotation);
  CHECK(received.ambiguity == sent.ambiguity);
  CHECK(received.has_alternative);
  CHECK(received.alternative.position == sent.alternative.position);
  CHECK(received.alternative.orientation.coeffs() == sent.alternative.orientation.coeffs());
}

TEST_CASE("arena coordinates and their deviations survive the way over the wire") {
  ArenaPose sent;
  sent.valid = true;
  sent.position = {1.25, 0.5, 0.125};
  sent.heading = -0.75;
  sent.sigma_position = {0.25, 0.5, 0.75};
  sent.sigma_heading = 0.0625;
  const ArenaPose received = arena_from_message(to_message(sample_marker(3), sent));
  CHECK(received.valid);
  CHECK(received.position == sent.position);
  CHECK(received.heading == sent.heading);
  CHECK(received.sigma_position == sent.sigma_position);
  CHECK(received.sigma_heading == sent.sigma_heading);
  CHECK_FALSE(arena_from_message(to_message(sample_marker(3))).valid);
  Marker no_pose = sample_marker(3);
  no_pose.has_pose = false;
  CHECK_FALSE(arena_from_message(to_message(no_pose, sent)).valid);
}

TEST_CASE("orientation is sent in the order w, x, y, z") {
  Marker marker = sample_marker(0);
  marker.pose.orientation = Eigen::Quaterniond(0.5, 0.25, 0.125, 0.0625);
  const marker_t message = to_message(marker);
  CHECK(message.orientation[0] == 0.5F);
  CHECK(message.orientation[1] == 0.25F);
  CHECK(message.orientation[2] == 0.125F);
  CHECK(message.orientation[3] == 0.0625F);
}

TEST_CASE("without a pose nothing that could be taken for one is sent") {
  Marker marker = sample_marker(0);
  marker.has_pose = false;
  const marker_t message = to_message(marker);
  CHECK(message.has_pose == 0);
  CHECK(message.position[2] == 0);
  CHECK(message.orientation[0] == 0);
  CHECK(message.has_alternative == 0);
  CHECK(message.alternative_position[2] == 0);
  CHECK(message.has_arena == 0);
  CHECK(message.u == 10.25F);
  CHECK_FALSE(from_message(message).has_pose);
}

TEST_CASE("the header carries what is known about the frame") {
  const header_t header = to_message(sample_information(42));
  CHECK(header.session == 1'700'000'000'000'000);
  CHECK(header.frame == 42);
  CHECK(header.dropped == 0);
  CHECK(header.capture_utime == 1'700'000'001'000'000);
  CHECK(header.capture_mono == 5'000'000);
  CHECK(header.publish_utime == 1'700'000'001'020'000);
  CHECK(header.publish_mono == 5'020'000);
  CHECK(header.tracking_us == 31.5F);
  CHECK(header.width == 1920);
  CHECK(header.height == 1080);
  CHECK(header.stamp_source == header_t::STAMP_MIDDLE_OF_EXPOSURE);
  CHECK(header.clock_state == header_t::CLOCK_SYNCHRONISED);
  CHECK(header.camera_state == header_t::CAMERA_STREAMING);
  CHECK(header.calibration_state == header_t::CALIBRATION_VALID);
  CHECK(header.arena_state == header_t::ARENA_NONE);
  CHECK(header.simulated == 1);
}
