#include "tools/pose_csv.hpp"

#include <fmt/format.h>

#include <array>
#include <stdexcept>

#include "daemon/json_fields.hpp"

namespace roundel {
namespace {

using Json = nlohmann::ordered_json;

// A column: its name, and where its value is in the marker (or, for the first ones, in the frame).
struct Column {
  const char* name;
  const char* pointer;
};

constexpr std::array kFrameColumns = {Column{"frame", "/frame"}, Column{"utime_us", "/utime"},
                                      Column{"session", "/session"}};

constexpr std::array kMarkerColumns = {Column{"id", "/id"},
                                       Column{"id_probability", "/id_probability"},
                                       Column{"track", "/track"},
                                       Column{"u_px", "/u"},
                                       Column{"v_px", "/v"},
                                       Column{"ellipse_a_px", "/ellipse/a"},
                                       Column{"ellipse_b_px", "/ellipse/b"},
                                       Column{"ellipse_angle_rad", "/ellipse/angle"},
                                       Column{"x_m", "/position/0"},
                                       Column{"y_m", "/position/1"},
                                       Column{"z_m", "/position/2"},
                                       Column{"qw", "/orientation/0"},
                                       Column{"qx", "/orientation/1"},
                                       Column{"qy", "/orientation/2"},
                                       Column{"qz", "/orientation/3"},
                                       Column{"sigma_x_m", "/sigma/position/0"},
                                       Column{"sigma_y_m", "/sigma/position/1"},
                                       Column{"sigma_z_m", "/sigma/position/2"},
                                       Column{"sigma_rotation_x_rad", "/sigma/rotation/0"},
                                       Column{"sigma_rotation_y_rad", "/sigma/rotation/1"},
                                       Column{"sigma_rotation_z_rad", "/sigma/rotation/2"},
                                       Column{"ambiguity", "/ambiguity"},
                                       Column{"arena_x_m", "/arena/x"},
                                       Column{"arena_y_m", "/arena/y"},
                                       Column{"arena_z_m", "/arena/z"},
                                       Column{"arena_heading_rad", "/arena/heading"},
                                       Column{"arena_sigma_x_m", "/arena/sigma/position/0"},
                                       Column{"arena_sigma_y_m", "/arena/sigma/position/1"},
                                       Column{"arena_sigma_z_m", "/arena/sigma/position/2"},
                                       Column{"arena_sigma_heading_rad", "/arena/sigma/heading"}};

// Empty where there is none.
std::string value_text(const Json& object, const Column& column) {
  const Json::json_pointer pointer(column.pointer);
  if (!object.contains(pointer)) return "";
  const Json& value = object.at(pointer);
  if (!value.is_number()) throw std::runtime_error(fmt::format("{} is not a number", column.name));
  return value.dump();
}

template <typename Columns>
std::string row_text(const Json& object, const Columns& columns) {
  std::string text;
  for (const Column& column : columns) {
    if (&column != columns.data()) text += ',';
    text += value_text(object, column);
  }
  return text;
}

}  // namespace

std::string pose_csv_heading() {
  std::string text;
  for (const Column& column : kFrameColumns) text += fmt::format("{},", column.name);
  for (const Column& column : kMarkerColumns) {
    text += column.name;
    text += &column == &kMarkerColumns.back() ? '\n' : ',';
  }
  return text;
}

std::string pose_csv_rows(const Json& frame) {
  field(frame, "frame");
  const Json& markers = array_field(frame, "markers");
  const std::string start = row_text(frame, kFrameColumns) + ',';
  if (markers.empty()) return start + row_text(Json::object(), kMarkerColumns) + '\n';
  std::string text;
  for (const Json& marker : markers) {
    field(marker, "id");
    text += start + row_text(marker, kMarkerColumns) + '\n';
  }
  return text;
}

}  // namespace roundel
