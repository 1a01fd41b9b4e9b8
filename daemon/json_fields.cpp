#include "daemon/json_fields.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/pose.hpp"

namespace roundel {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kUnitTolerance = 1e-3;  // for rounded output of other programs

[[noreturn]] void refuse(const char* key, const std::string& should) {
  throw std::runtime_error(fmt::format("{} {}", key, should));
}

// JSON can't write infinity and NaN; numbers too large for a double are refused by the parser.
template <std::size_t N>
std::array<double, N> numbers(const Json& object, const char* key) {
  const Json& list = field(object, key);
  std::array<double, N> values{};
  bool good = list.is_array() && list.size() == N;
  for (std::size_t i = 0; good && i < N; ++i) {
    good = list[i].is_number();
    values[i] = good ? list[i].get<double>() : 0;
  }
  if (!good) {
    refuse(key, fmt::format("is not a list of {} numbers", N));
  }
  return values;
}

}  // namespace

bool has_field(const Json& object, const char* key) {
  return object.is_object() && object.contains(key);
}

const Json& field(const Json& object, const char* key) {
  if (!object.is_object()) {
    throw std::runtime_error(fmt::format("no object where one with \"{}\" should be", key));
  }
  const auto found = object.find(key);
  if (found == object.end()) {
    refuse(key, "is missing");
  }
  return *found;
}

double number_field(const Json& object, const char* key) {
  const Json& value = field(object, key);
  if (!value.is_number()) {
    refuse(key, "is not a number");
  }
  return value.get<double>();
}

std::int64_t integer_field(const Json& object, const char* key, std::int64_t least,
                           std::int64_t most) {
  const Json& value = field(object, key);
  if (!value.is_number_integer()) {
    refuse(key, "is not a whole number");
  }
  const bool too_large = value.is_number_unsigned() &&
                         value.get<std::uint64_t>() >
                             static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  const std::int64_t whole = too_large ? 0 : value.get<std::int64_t>();
  if (too_large || whole < least || whole > most) {
    refuse(key, fmt::format("is {}, not between {} and {}", value.dump(), least, most));
  }
  return whole;
}

bool bool_field(const Json& object, const char* key) {
  const Json& value = field(object, key);
  if (!value.is_boolean()) {
    refuse(key, "is not true or false");
  }
  return value.get<bool>();
}

std::string string_field(const Json& object, const char* key) {
  const Json& value = field(object, key);
  if (!value.is_string()) {
    refuse(key, "is not a text");
  }
  return value.get<std::string>();
}

const Json& array_field(const Json& object, const char* key) {
  const Json& value = field(object, key);
  if (!value.is_array()) {
    refuse(key, "is not a list");
  }
  return value;
}

Eigen::Vector3d vector_field(const Json& object, const char* key) {
  const auto v = numbers<3>(object, key);
  return {v[0], v[1], v[2]};
}

Eigen::Quaterniond quaternion_field(const Json& object, const char* key) {
  const auto v = numbers<4>(object, key);
  const Eigen::Quaterniond q(v[0], v[1], v[2], v[3]);
  if (!(std::abs(q.norm() - 1) < kUnitTolerance)) {
    refuse(key, "is not a unit quaternion");
  }
  return with_positive_w(q.normalized());
}

}  // namespace roundel
