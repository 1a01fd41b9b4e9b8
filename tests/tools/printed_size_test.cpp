// What comes out of a printer: the files are rendered by other programs (poppler, librsvg) at a
// known resolution, and the black disc is measured in them.

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

#include "core/marker_geometry.hpp"
#include "daemon/image_file.hpp"
#include "tests/tools/run_roundel.hpp"
#include "tools/sheet_layout.hpp"

namespace roundel {
namespace {

constexpr double kDpi = 600;
constexpr double kPixelsPerMm = kDpi / kMillimetresPerInch;

struct Disc {
  double u = 0, v = 0;                        // centre, pixels
  double diameter_min = 0, diameter_max = 0;  // over all directions, pixels
};

double sample(const GreyImage& image, double u, double v) {
  const int u0 = static_cast<int>(std::floor(u));
  const int v0 = static_cast<int>(std::floor(v));
  const double fu = u - u0;
  const double fv = v - v0;
  const LumaView view = image.view();
  if (!view.contains(u0, v0) || !view.contains(u0 + 1, v0 + 1)) {
    FAIL("outside the picture");
  }
  return (1 - fv) * ((1 - fu) * view.at(u0, v0) + fu * view.at(u0 + 1, v0)) +
         fv * ((1 - fu) * view.at(u0, v0 + 1) + fu * view.at(u0 + 1, v0 + 1));
}

// From within the black ring outwards to where half of the white is reached.
double edge(const GreyImage& image, double u, double v, double angle, double radius) {
  double r = 0.8 * radius;
  REQUIRE(sample(image, u + r * std::cos(angle), v + r * std::sin(angle)) < 20);
  while (sample(image, u + r * std::cos(angle), v + r * std::sin(angle)) < 127.5) {
    r += 0.02;
  }
  return r;
}

// The disc about a point that is roughly its centre.
Disc measure_disc(const GreyImage& image, double u, double v, double radius) {
  Disc disc;
  const double pi = std::numbers::pi;
  disc.u = u + (edge(image, u, v, 0, radius) - edge(image, u, v, pi, radius)) / 2;
  disc.v = v + (edge(image, u, v, pi / 2, radius) - edge(image, u, v, -pi / 2, radius)) / 2;
  disc.diameter_min = 1e9;
  for (int i = 0; i < 36; ++i) {
    const double angle = i * pi / 36;
    const double diameter = edge(image, disc.u, disc.v, angle, radius) +
                            edge(image, disc.u, disc.v, angle + pi, radius);
    disc.diameter_min = std::min(disc.diameter_min, diameter);
    disc.diameter_max = std::max(disc.diameter_max, diameter);
  }
  return disc;
}

void check_diameter(const Disc& disc, double diameter_mm) {
  CHECK(std::abs(disc.diameter_min / kPixelsPerMm - diameter_mm) < 0.02);
  CHECK(std::abs(disc.diameter_max / kPixelsPerMm - diameter_mm) < 0.02);
}

GreyImage render_pdf(const TemporaryDirectory& directory, const std::string& pdf, int page) {
  const CommandResult result =
      run_command("pdftoppm -gray -singlefile -r 600 -f " + std::to_string(page) + " " + pdf + " " +
                  directory.file("page"));
  REQUIRE_MESSAGE(result.status == 0, "poppler-utils is needed: ", result.err);
  return load_image(directory.file("page.pgm"));
}

GreyImage render_svg(const TemporaryDirectory& directory, const std::string& svg) {
  const CommandResult result = run_command("rsvg-convert --dpi-x 600 --dpi-y 600 -b white -o " +
                                           directory.file("svg.png") + " " + svg);
  REQUIRE_MESSAGE(result.status == 0, "librsvg2-bin is needed: ", result.err);
  return load_image(directory.file("svg.png"));
}

}  // namespace

TEST_CASE("a marker alone measures its diameter in PDF, SVG and PNG alike") {
  const TemporaryDirectory directory;
  for (const double diameter_mm : {122.0, 25.0}) {
    CAPTURE(diameter_mm);
    const std::string options = "markers --id 7 --paper none --dpi 600 --diameter " +
                                std::to_string(diameter_mm / 1000) + " -o ";
    for (const char* name : {"m.pdf", "m.svg", "m.png"}) {
      REQUIRE(run_roundel(options + directory.file(name)).status == 0);
    }
    const double middle = diameter_mm * kMarginRatio / 2 * kPixelsPerMm - 0.5;
    const double radius = diameter_mm / 2 * kPixelsPerMm;
    for (const GreyImage& image :
         {render_pdf(directory, directory.file("m.pdf"), 1),
          render_svg(directory, directory.file("m.svg")), load_image(directory.file("m.png"))}) {
      CHECK(std::abs(image.width - 2 * middle - 1) <= 1);
      CHECK(image.height == image.width);
      const Disc disc = measure_disc(image, middle, middle, radius);
      check_diameter(disc, diameter_mm);
      CHECK(std::abs(disc.u - middle) < 1);
      CHECK(std::abs(disc.v - middle) < 1);
    }
  }
}

TEST_CASE("the same marker has the same pattern in PDF, SVG and PNG") {
  const TemporaryDirectory directory;
  for (const char* name : {"m.pdf", "m.svg", "m.png"}) {
    REQUIRE(run_roundel("markers --id 13 --paper none --dpi 600 --diameter 0.04 -o " +
                        directory.file(name))
                .status == 0);
  }
  const GreyImage png = load_image(directory.file("m.png"));
  const double middle = 20 * kMarginRatio * kPixelsPerMm - 0.5;
  for (const GreyImage& other : {render_pdf(directory, directory.file("m.pdf"), 1),
                                 render_svg(directory, directory.file("m.svg"))}) {
    int compared = 0;
    int different = 0;
    for (int i = 0; i < 115; ++i) {
      const double r = 0.055 + 0.01 * i;
      for (int k = 0; k < 628; ++k) {
        const double angle = 0.005 + 0.01 * k;
        const double u = middle + r * 20 * kPixelsPerMm * std::cos(angle);
        const double v = middle - r * 20 * kPixelsPerMm * std::sin(angle);
        ++compared;
        different += (sample(png, u, v) < 128) != (sample(other, u, v) < 128) ? 1 : 0;
      }
    }
    CHECK(different < compared / 500);  // edges apart
  }
}

TEST_CASE("a sheet prints every marker at its place, size and with a ruler that is right") {
  const TemporaryDirectory directory;
  REQUIRE(run_roundel("markers --ids 1-15 --diameter 0.05 -o " + directory.file("s.pdf")).status ==
          0);
  const SheetLayout layout = lay_out_sheet("A4", 50);
  REQUIRE(layout.cells() == 12);
  for (const int page : {1, 2}) {
    const GreyImage image = render_pdf(directory, directory.file("s.pdf"), page);
    CHECK(std::abs(image.width - 210 * kPixelsPerMm) <= 1);
    CHECK(std::abs(image.height - 297 * kPixelsPerMm) <= 1);
    for (int cell = 0; cell < (page == 1 ? 12 : 3); ++cell) {
      const int column = cell % layout.columns;
      const int row = cell / layout.columns;
      const double u = (layout.left_mm + (column + 0.5) * layout.cell_mm) * kPixelsPerMm - 0.5;
      const double v = (layout.top_mm + (row + 0.5) * layout.cell_mm) * kPixelsPerMm - 0.5;
      const Disc disc = measure_disc(image, u, v, 25 * kPixelsPerMm);
      check_diameter(disc, 50);
      CHECK(std::abs(disc.u - u) < 1);
      CHECK(std::abs(disc.v - v) < 1);
    }
    // The ruler's line ends where 170 mm end, and has a tick at every millimetre.
    const double top = (layout.ruler_top_mm + 3) * kPixelsPerMm;
    for (int mm = 0; mm <= 170; ++mm) {
      const double u = (20 + mm) * kPixelsPerMm - 0.5;
      CHECK(sample(image, u, top) < 100);
      CHECK(sample(image, u + 0.5 * kPixelsPerMm, top) > 250);
    }
  }
}

TEST_CASE("a sheet names the ids, the set and the diameter to measure") {
  const TemporaryDirectory directory;
  REQUIRE(run_roundel("markers --ids 3,28 --bits 9 --hamming 2 --diameter 0.08 -o " +
                      directory.file("s.pdf"))
              .status == 0);
  const CommandResult text = run_command("pdftotext -layout " + directory.file("s.pdf") + " -");
  REQUIRE(text.status == 0);
  for (const char* words :
       {"id 3", "id 28", "9 bits, d 2", "80.0 mm", "170 mm", "measure the black disc: 80.0 mm"}) {
    CAPTURE(words);
    CHECK(contains(text.out, words));
  }
}

TEST_CASE("a printed PNG carries its resolution") {
  const TemporaryDirectory directory;
  REQUIRE(run_roundel("markers --plain --dpi 300 -o " + directory.file("m.png")).status == 0);
  const std::string bytes = read_file(directory.file("m.png"));
  const std::size_t chunk = bytes.find("pHYs");
  REQUIRE(chunk != std::string::npos);
  // 300 dpi are 11811 pixels a metre, 0x2e23, both ways.
  CHECK(bytes.substr(chunk + 4, 9) == std::string("\0\0\x2e\x23\0\0\x2e\x23\1", 9));
}

}  // namespace roundel
