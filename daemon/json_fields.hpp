#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace roundel {

// Typed fields of JSON objects that come from outside. Every function throws std::runtime_error
// that names the field and says what it should be.

bool has_field(const nlohmann::ordered_json& object, const char* key);
const nlohmann::ordered_json& field(const nlohmann::ordered_json& object, const char* key);

double number_field(const nlohmann::ordered_json& object, const char* key);  // finite
std::int64_t integer_field(const nlohmann::ordered_json& object, const char* key,
                           std::int64_t least, std::int64_t most);
bool bool_field(const nlohmann::ordered_json& object, const char* key);
std::string string_field(const nlohmann::ordered_json& object, const char* key);
const nlohmann::ordered_json& array_field(const nlohmann::ordered_json& object, const char* key);
Eigen::Vector3d vector_field(const nlohmann::ordered_json& object, const char* key);  // [x, y, z]

// [w, x, y, z] of unit length; exactly so, and with w >= 0, afterwards.
Eigen::Quaterniond quaternion_field(const nlohmann::ordered_json& object, const char* key);

}  // namespace roundel
