#include "tools/arena_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "daemon/json_fields.hpp"

namespace roundel {

std::string arena_report(const nlohmann::ordered_json& arena) {
  constexpr double kWorthTelling = 0.03;
  std::string text =
      fmt::format("Arena of {:g} x {:g} m, certain to {:.2f} mm after {} frames.\n",
                  number_field(arena, "width"), number_field(arena, "height"),
                  number_field(arena, "certainty_mm"), number_field(arena, "frames"));
  int number = 0;
  for (const auto& marker : array_field(arena, "fixed_markers")) {
    ++number;
    const auto id = integer_field(marker, "id", -1, 65535);
    text += fmt::format(
        "  {} {:<7} at ({:.3f}, {:.3f}) m, pixel ({:.1f}, {:.1f}): residual {:.1f} mm\n",
        number <= 4 ? "corner" : "anchor", id < 0 ? "plain" : fmt::format("id {}", id),
        number_field(marker, "x"), number_field(marker, "y"), number_field(marker, "u"),
        number_field(marker, "v"), number_field(marker, "residual_mm"));
  }
  text += "  sides, measured minus given:";
  for (const auto& side : array_field(arena, "side_errors_mm")) {
    text += fmt::format(" {:+.1f}", side.is_number() ? side.get<double>() : 0.0);
  }
  text += " mm\n";
  const double size = number_field(arena, "size_by_markers");
  if (std::abs(size - 1) > kWorthTelling) {
    text += fmt::format(
        "  By the markers' own size the arena is {:.1f} % {} than that. Is marker.diameter what "
        "the "
        "black disc measures?\n",
        100 * std::abs(size - 1), size > 1 ? "larger" : "smaller");
  }
  return text;
}

}  // namespace roundel
