#include <doctest/doctest.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "calibration/arena_file.hpp"
#include "tests/daemon/control_rig.hpp"
#include "tests/error_of.hpp"

using namespace roundel;
using namespace roundel::test;
using namespace std::chrono_literals;
using Json = nlohmann::json;

namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

Json body_of(const std::string& answer) {
  const std::size_t end = answer.find("\r\n\r\n");
  REQUIRE(end != std::string::npos);
  return Json::parse(answer.substr(end + 4));
}

// Until the calibration that runs has ended.
Json wait_for_calibration(const ControlRig& rig) {
  for (int i = 0; i < 3000; ++i) {
    Json state = body_of(ask(rig.socket(), "GET", "/v1/calibration"));
    if (state["run"]["state"] != "running") return state;
    ::poll(nullptr, 0, 10);
  }
  return {};
}

// Frames have come through to clients.
void wait_for_frames(const ControlRig& rig) {
  for (int i = 0; i < 3000; ++i) {
    if (has(ask(rig.socket(), "GET", "/v1/markers"), "200 OK")) return;
    ::poll(nullptr, 0, 10);
  }
}

}  // namespace

TEST_CASE("the control socket tells status, markers and calibration") {
  const ControlRig rig;
  wait_for_frames(rig);
  const Json markers = body_of(ask(rig.socket(), "GET", "/v1/markers"));
  CHECK(markers["source"] == "ceiling");
  CHECK(markers["markers"].size() == 4);
  CHECK(body_of(ask(rig.socket(), "GET", "/v1/status"))["arena"]["state"] == "none");
  CHECK(body_of(ask(rig.socket(), "GET", "/v1/calibration"))["arena"].is_null());
  CHECK(body_of(ask(rig.socket(), "GET", "/v1/controls"))["controls"].empty());
}

TEST_CASE("the arena is calibrated over the control socket, kept, restored and forgotten") {
  const ControlRig rig;
  wait_for_frames(rig);
  const std::string request = R"({"width": 3, "height": 2})";
  CHECK(has(ask(rig.socket(), "POST", "/v1/calibration/arena", request), "202"));
  const Json state = wait_for_calibration(rig);
  CHECK(state["run"]["state"] == "done");
  REQUIRE(ArenaStore(rig.file()).load().has_value());
  for (int i = 0; i < 3000 && rig.arenas_set == 0; ++i) ::poll(nullptr, 0, 1);
  CHECK(rig.arenas_set == 1);

  CHECK(has(ask(rig.socket(), "POST", "/v1/calibration/restore"), "409"));
  CHECK(has(ask(rig.socket(), "POST", "/v1/calibration/arena", request), "202"));
  CHECK(wait_for_calibration(rig)["run"]["state"] == "done");
  CHECK(has(ask(rig.socket(), "POST", "/v1/calibration/restore"), "200 OK"));
  CHECK(has(ask(rig.socket(), "DELETE", "/v1/calibration/arena"), "200 OK"));
  CHECK_FALSE(ArenaStore(rig.file()).load().has_value());
}

TEST_CASE("a calibration that fails says why and changes nothing") {
  const ControlRig rig;
  wait_for_frames(rig);
  CHECK(has(ask(rig.socket(), "POST", "/v1/calibration/arena",
                R"({"width": 3, "height": 2.5, "time_limit": 0.5})"),
            "202"));
  CHECK(has(ask(rig.socket(), "POST", "/v1/calibration/arena", R"({"width": 3, "height": 2})"),
            "running already"));
  const Json state = wait_for_calibration(rig);
  CHECK(state["run"]["state"] == "failed");
  CHECK(has(state["run"]["text"], "no rectangle of 3 x 2.5 m"));
  CHECK_FALSE(ArenaStore(rig.file()).load().has_value());
  CHECK(rig.arenas_set == 0);
}

TEST_CASE("a calibration that is asked for before the first frame waits for it") {
  ControlRig rig(false);
  const std::string request = R"({"width": 3, "height": 2})";
  CHECK(has(ask(rig.socket(), "POST", "/v1/calibration/arena", request), "202"));
  CHECK(has(ask(rig.socket(), "POST", "/v1/calibration/arena", request), "running already"));
  const Json waiting = body_of(ask(rig.socket(), "GET", "/v1/calibration"))["run"];
  CHECK(waiting["state"] == "running");
  CHECK(waiting["text"] == "waiting for the first frame");
  rig.show_frames();
  CHECK(wait_for_calibration(rig)["run"]["state"] == "done");
}

TEST_CASE("a calibration is restored and put aside before the first frame, too") {
  ControlRig rig(false);
  CHECK(has(ask(rig.socket(), "POST", "/v1/calibration/restore"), "no calibration before"));
  rig.show_frames();
  const std::string request = R"({"width": 3, "height": 2})";
  CHECK(has(ask(rig.socket(), "POST", "/v1/calibration/arena", request), "202"));
  REQUIRE(wait_for_calibration(rig)["run"]["state"] == "done");
  const ArenaCalibration calibration = *ArenaStore(rig.file()).load();

  const ControlRig late(false);
  ArenaStore(late.file()).save(calibration);
  CHECK(has(ask(late.socket(), "DELETE", "/v1/calibration/arena"), "200 OK"));
  CHECK_FALSE(ArenaStore(late.file()).load().has_value());
  CHECK(has(ask(late.socket(), "POST", "/v1/calibration/restore"), calibration.date));
  CHECK(ArenaStore(late.file()).load().has_value());
}

TEST_CASE("a calibration without any frame ends with its time limit, and says so") {
  const ControlRig rig(false);
  CHECK(has(ask(rig.socket(), "POST", "/v1/calibration/arena",
                R"({"width": 3, "height": 2, "time_limit": 0.3})"),
            "202"));
  const Json run = wait_for_calibration(rig)["run"];
  CHECK(run["state"] == "failed");
  CHECK(run["text"] == "no frame has come from the camera yet");
  CHECK(has(ask(rig.socket(), "POST", "/v1/calibration/arena", R"({"width": 0, "height": 2})"),
            "400 Bad Request"));
}

TEST_CASE("a bumped camera is told to the loop, and calibrated again if that is configured") {
  ControlRig rig;
  wait_for_frames(rig);
  CHECK(has(ask(rig.socket(), "POST", "/v1/calibration/arena", R"({"width": 3, "height": 2})"),
            "202"));
  REQUIRE(wait_for_calibration(rig)["run"]["state"] == "done");
  const auto watch_says = [&](const std::string& what) {
    for (int i = 0; i < 2000; ++i) {
      const Json state = body_of(ask(rig.socket(), "GET", "/v1/calibration"));
      if (state.contains("watch") && has(state["watch"], what)) return true;
      ::poll(nullptr, 0, 10);
    }
    return false;
  };
  CHECK(watch_says("in their places"));
  const Eigen::Vector3d before = ArenaStore(rig.file()).load()->arena_in_camera.position;
  rig.bump();
  for (int i = 0; i < 20000 && !rig.moved; ++i) ::poll(nullptr, 0, 1);
  CHECK(rig.moved);
  for (int i = 0; i < 20000 && rig.arenas_set < 2; ++i) ::poll(nullptr, 0, 1);
  CHECK(rig.arenas_set == 2);
  CHECK(watch_says("in their places"));
  CHECK((ArenaStore(rig.file()).load()->arena_in_camera.position - before).norm() > 0.01);
}

TEST_CASE("requests that make no sense are refused with a reason") {
  const ControlRig rig;
  wait_for_frames(rig);
  const auto calibrate = [&](const std::string& body) {
    return ask(rig.socket(), "POST", "/v1/calibration/arena", body);
  };
  CHECK(has(ask(rig.socket(), "GET", "/v1/nothing"), "404"));
  CHECK(has(ask(rig.socket(), "GET", "/v1/../../etc/passwd"), "404"));
  CHECK(has(ask(rig.socket(), "PUT", "/v1/status"), "405"));
  CHECK(has(ask(rig.socket(), "DELETE", "/v1/reload"), "Allow: POST"));
  CHECK(has(calibrate(""), "not valid JSON"));
  CHECK(has(calibrate(std::string(60000, '[')), "not valid JSON"));
  CHECK(has(calibrate("[1]"), "must be a JSON object"));
  CHECK(has(calibrate("{}"), "width is missing"));
  CHECK(has(calibrate(R"({"width": 3, "height": 2, "depth": 1})"), "there is no field depth"));
  CHECK(has(calibrate(R"({"width": 3, "height": 2, "origin": "middle"})"), "origin is not"));
  CHECK(has(calibrate(R"({"width": 3, "height": 2, "ids": [1, 2]})"), "four corner ids"));
  CHECK(has(calibrate(R"({"width": -3, "height": 2})"), "width and height"));
  CHECK(has(ask(rig.socket(), "PUT", "/v1/controls", R"({"gain": 3})"), "409"));
}

TEST_CASE("reload answers with what is wrong") {
  ControlRig rig;
  CHECK(has(ask(rig.socket(), "POST", "/v1/reload"), "200 OK"));
  rig.reload_error = "a.yaml:3:1: no such key";
  const std::string answer = ask(rig.socket(), "POST", "/v1/reload");
  CHECK(has(answer, "422"));
  CHECK(has(answer, "a.yaml:3:1: no such key"));
}

TEST_CASE("a reload that moves the socket is answered at the old one") {
  const TemporaryDirectory folder;
  ControlRig rig;
  rig.moved_socket = folder.file("moved.sock");
  CHECK(has(ask(rig.socket(), "POST", "/v1/reload"), "200 OK"));
  for (int i = 0; i < 3000 && ::access(rig.moved_socket.c_str(), F_OK) != 0; ++i) {
    ::poll(nullptr, 0, 10);
  }
  CHECK(has(ask(rig.moved_socket, "GET", "/v1/status"), "200 OK"));
  CHECK(::access(rig.socket().c_str(), F_OK) != 0);
}

TEST_CASE("pictures come as JPEG, PNG and PGM") {
  const ControlRig rig;
  const std::string jpeg = ask(rig.socket(), "GET", "/v1/frame.jpg");
  CHECK(has(jpeg, "Content-Type: image/jpeg"));
  CHECK(has(jpeg, "\r\n\r\n\xff\xd8\xff"));
  const std::string png = ask(rig.socket(), "GET", "/v1/frame.png?overlay=0");
  CHECK(has(png, "\r\n\r\n\x89PNG"));
  const std::string pgm = ask(rig.socket(), "GET", "/v1/frame.pgm");
  const std::string head = "\r\n\r\nP5\n1920 1080\n255\n";
  REQUIRE(has(pgm, head));
  CHECK(pgm.size() - pgm.find(head) - head.size() == 1920 * 1080);
}

TEST_CASE("answers that clients leave untaken don't fill the memory") {
  const TemporaryDirectory folder;
  ControlSocket socket(folder.file("a.sock"), "");
  HttpLimits limits;
  limits.untaken = std::size_t{10} << 20;
  HttpServer server(
      socket.take_descriptor(),
      [](const HttpRequest& request) {
        HttpResponse response;
        response.body.assign(request.path == "/large" ? std::size_t{4} << 20 : 100, 'x');
        return response;
      },
      limits);
  std::vector<std::unique_ptr<UnixClient>> lazy;
  for (int i = 0; i < 3; ++i) {
    lazy.push_back(std::make_unique<UnixClient>(folder.file("a.sock")));
    lazy.back()->send("GET /large HTTP/1.1\r\nHost: x\r\n\r\n");
    // It is there, and all but the beginning of it waits.
    CHECK(has(lazy.back()->read_until("HTTP/1.1 ", 30s), "HTTP/1.1 "));
  }
  CHECK(has(ask(folder.file("a.sock"), "GET", "/large"), "503"));
  CHECK(has(ask(folder.file("a.sock"), "GET", "/small"), "200 OK"));
  lazy.clear();
  bool room = false;
  for (int i = 0; i < 3000 && !room; ++i) {
    room = has(ask(folder.file("a.sock"), "GET", "/large"), "200 OK");
  }
  CHECK(room);
}

TEST_CASE("events tell of one frame after another") {
  const ControlRig rig;
  const UnixClient client(rig.socket());
  client.send("GET /v1/events HTTP/1.1\r\nHost: x\r\n\r\n");
  CHECK(has(client.read_until("event: frame", 30s), "text/event-stream"));
  CHECK(has(client.read_until("event: frame", 30s), "\"markers\""));
}

TEST_CASE("two hundred idle clients, slow readers, garbage and endless bodies harm no frame") {
  ControlRig rig;
  wait_for_frames(rig);
  std::vector<std::unique_ptr<UnixClient>> clients;
  const auto more = [&]() -> UnixClient& {
    return *clients.emplace_back(std::make_unique<UnixClient>(rig.socket()));
  };
  for (int i = 0; i < 200; ++i) more();
  for (int i = 0; i < 20; ++i) more().send("GET /v1/status HT");  // and nothing more
  for (int i = 0; i < 12; ++i) more().send("GET /v1/events HTTP/1.1\r\nHost: x\r\n\r\n");
  for (int i = 0; i < 5; ++i) more().send("GET /v1/frame.png HTTP/1.1\r\nHost: x\r\n\r\n");
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    std::string garbage;
    for (int k = 0; k < 2000; ++k) garbage += static_cast<char>(random.integer(0, 255));
    more().send(garbage);
  }
  for (int i = 0; i < 5; ++i) more().send("GET /" + std::string(100000, 'a') + " HTTP/1.1\r\n");

  // A gigabyte is refused when it is announced...
  CHECK(has(UnixClient(rig.socket()).ask("POST", "/v1/reload", std::string(1 << 20, 'x')), "413"));
  const UnixClient announced(rig.socket());
  announced.send(
      "POST /v1/calibration/arena HTTP/1.1\r\nHost: x\r\nContent-Length: 1073741824\r\n\r\n");
  CHECK(has(announced.read_until("", 30s), "413"));
  // ... and cut off when it just comes.
  const UnixClient endless(rig.socket());
  endless.send(
      "POST /v1/calibration/arena HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n");
  const std::string chunk = "10000\r\n" + std::string(0x10000, 'x') + "\r\n";
  std::size_t sent = 0;
  for (int i = 0; i < 16384; ++i) {  // a gigabyte
    const std::size_t taken = endless.send(chunk);
    sent += taken;
    if (taken < chunk.size()) break;
  }
  CHECK(sent < (std::size_t{4} << 20));

  // Somebody with an honest question still gets an answer.
  CHECK(has(ask(rig.socket(), "GET", "/v1/status"), "200 OK"));
  const std::int64_t before = rig.frames();
  while (rig.frames() < before + 100) ::poll(nullptr, 0, 1);
  std::vector<double> times = rig.hand_over_us();
  std::sort(times.begin(), times.end());
  const double median = times[times.size() / 2];
  MESSAGE("the loop left a frame in " << median << " us (median), " << times.back()
                                      << " us (worst of " << times.size() << ")");
  CHECK(median < 5000);
}

TEST_CASE("a client that says nothing is sent away") {
  const TemporaryDirectory folder;
  ControlSocket socket(folder.file("a.sock"), "");
  HttpLimits limits;
  limits.idle = 1s;
  HttpServer server(
      socket.take_descriptor(), [](const HttpRequest&) { return HttpResponse(); }, limits);
  const UnixClient silent(folder.file("a.sock"));
  const auto start = std::chrono::steady_clock::now();
  CHECK(silent.read_until("", 20s).empty());
  CHECK(std::chrono::steady_clock::now() - start < 15s);
}

TEST_CASE("a client that drips is cut off when its time is over") {
  const TemporaryDirectory folder;
  ControlSocket socket(folder.file("a.sock"), "");
  HttpLimits limits;
  limits.whole = 0s;
  HttpServer server(
      socket.take_descriptor(), [](const HttpRequest&) { return HttpResponse(); }, limits);
  const UnixClient dripping(folder.file("a.sock"));
  bool cut = false;
  for (int i = 0; i < 2000 && !cut; ++i) {
    cut = dripping.send("G") == 0;
    server.end_overdue();
    ::poll(nullptr, 0, 2);
  }
  CHECK(cut);
}

TEST_CASE("the control socket is for its group, replaces a dead one and spares a live one") {
  const TemporaryDirectory folder;
  const std::string path = folder.file("a.sock");
  {
    const ControlSocket first(path, "");
    struct stat status {};
    REQUIRE(::stat(path.c_str(), &status) == 0);
    CHECK((status.st_mode & 0777) == 0660);
    CHECK(has(error_of([&] { ControlSocket(path, ""); }), "another roundeld"));
  }
  CHECK(::access(path.c_str(), F_OK) != 0);
  {
    ControlSocket dead(path, "");
    dead.take_descriptor().reset();
    CHECK(error_of([&] { ControlSocket(path, ""); }).empty());
  }
  folder.write("file", "x");
  CHECK(has(error_of([&] { ControlSocket(folder.file("file"), ""); }), "is no socket"));
  CHECK(has(error_of([&] { ControlSocket("/nonexistent/a.sock", ""); }), "No such file"));
  CHECK(has(error_of([&] { ControlSocket(std::string(200, 'a'), ""); }), "107 characters"));
  CHECK(has(ControlSocket(path, "no-such-group").remark(), "there is no group no-such-group"));
}

TEST_CASE("the newest of the values handed over is taken, and none twice") {
  LatestValue<int> values;
  CHECK(values.take() == nullptr);
  for (const int value : {1, 2, 3}) {
    values.back() = value;
    values.publish();
  }
  const int* taken = values.take();
  REQUIRE(taken != nullptr);
  CHECK(*taken == 3);
  CHECK(values.take() == nullptr);

  constexpr int kLast = 200000;
  std::thread writer([&] {
    for (int i = 4; i <= kLast; ++i) {
      values.back() = i;
      values.publish();
    }
  });
  int newest = 3;
  bool rising = true;
  while (newest < kLast) {
    if (const int* const value = values.take()) {
      rising = rising && *value > newest;
      newest = *value;
    }
  }
  writer.join();
  CHECK(rising);
}
