#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/detector_parameters.hpp"

namespace roundel {

// What the user sets, one struct a section of roundel.yaml, where every key is explained. These
// defaults are those of the embedded file (tested); fields.cpp has names and ranges.

enum class SourceKind { kSimulator, kFiles, kCamera };

struct SimulatorSettings {
  int width = 1920, height = 1080;  // pixels
  double frame_rate = 30;           // frames a second
  int robots = 12;
  bool corner_markers = true;  // four markers in the arena's corners
  int seed = 1;
  double noise = 3;                          // grey levels, one standard deviation
  double blur = 0.7;                         // pixels, one standard deviation
  double exposure = 0.005;                   // seconds
  bool clutter = true;                       // things on the floor, some of them much like markers
  double arena_length = 3, arena_width = 2;  // metres, the rectangle of the corner markers
  double camera_height = 3;                  // metres above the floor
};

struct FilesSettings {
  std::vector<std::string> paths;
  double frame_rate = 30;  // frames a second; 0: as fast as they are tracked
  bool loop = false;
};

struct CameraSettings {
  std::string name = "camera";
  std::string calibration;        // path; empty: none (the simulator knows its own lens)
  std::string response = "auto";  // or ResponseCurve::named()

  // Which camera; all empty: the first that can capture.
  std::string device;                               // node or link
  std::string match_card, match_bus, match_serial;  // part of the name; exactly; exactly

  std::string format = "auto";                                       // V4L2's four letters
  int width = 0, height = 0;                                         // pixels; 0: what suits
  double frame_rate = 30;                                            // frames a second
  int crop_left = 0, crop_top = 0, crop_width = 0, crop_height = 0;  // pixels; width 0: none
  int buffers = 4;
  double timeout = 0.4;                         // seconds
  std::map<std::string, std::string> controls;  // by their V4L2 names
};

// How robots wear their markers; metres and radians, in the robot's frame.
struct MountSettings {
  double height = 0;  // of the marker's face above the floor
  double offset_x = 0, offset_y = 0;
  double rotation = 0;
  std::vector<std::string> mounts;  // robots that differ, "7 height=0.12"
};

struct ArenaSettings {
  std::string mode = "2d";  // or 3d
  std::string file = "/var/lib/roundel/arena.yaml";
  bool recalibrate = false;  // by itself, after the camera has been moved
};

struct ControlSettings {
  std::string socket = "/run/roundel/control.sock";  // empty: none
  std::string group = "roundel";                     // who may use it; empty: roundeld's own group
  std::string web;    // ADDRESS:PORT that the same is served on over TCP; empty: none
  std::string token;  // that web clients must have; empty: none
  bool operator==(const ControlSettings&) const = default;
};

struct LcmSettings {
  std::string url = "udpm://239.255.76.67:7667?ttl=0";
  std::string interface_name;       // of the network, for multicast; empty: as the routes say
  std::vector<std::string> copies;  // URLs that every message goes to besides
  std::string channel = "ROUNDEL";  // prefix of all channels
  bool per_marker = false;
  int max_datagram = 1400;  // bytes
};

struct Configuration {
  SourceKind source = SourceKind::kSimulator;
  SimulatorSettings simulator;
  FilesSettings files;
  CameraSettings camera;
  DetectorParameters detector;  // sections marker and detector
  int tracking_threads = 1;     // section detector
  MountSettings mount;          // section marker
  ArenaSettings arena;
  ControlSettings control;
  LcmSettings lcm;
};

}  // namespace roundel
