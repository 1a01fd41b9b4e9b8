#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/necklace.hpp"
#include "daemon/image_file.hpp"
#include "tools/board_sheet.hpp"
#include "tools/commands.hpp"
#include "tools/id_list.hpp"
#include "tools/marker_sheet.hpp"
#include "tools/page_output.hpp"

namespace roundel {
namespace {

constexpr double kMinDiameter = 0.001, kMaxDiameter = 5;  // metres
constexpr int kMaxCopies = 1000;

struct MarkersOptions {
  int bits = 8;
  int hamming = 1;
  std::string ids;
  bool all = false;
  std::optional<double> plain_ratio;
  bool board = false;
  int columns = Board{}.columns, rows = Board{}.rows;
  std::optional<double> spacing_m;         // of the board; else as large as fits
  std::optional<double> given_diameter_m;  // on the command line
  int copies = 1;
  double diameter_m = kDefaultDiameter;  // of what is printed
  std::string paper = "A4";
  std::string output;
  std::string format = "pdf";  // of the files in a directory
  double dpi = 300;
  int pixels = 0;  // 0: by dpi
};

double diameter_mm(const MarkersOptions& options) {
  return options.diameter_m * 1000;
}
bool bare(const MarkersOptions& options) {
  return options.paper == "none";
}

PrintedMarker code_marker(const NecklaceCode& code, int id) {
  const std::string set = code.hamming() > 1
                              ? fmt::format("{} bits, d {}", code.bits(), code.hamming())
                              : fmt::format("{} bits", code.bits());
  return {{code.bits(), code.word(id).value(), 0}, fmt::format("id {}", id), set};
}

std::vector<PrintedMarker> chosen_markers(const MarkersOptions& options) {
  std::vector<PrintedMarker> markers;
  if (options.plain_ratio) {
    const double ratio = *options.plain_ratio;
    if (!(ratio >= kPlainInnerRatioMin && ratio <= kPlainInnerRatioMax)) {
      throw UsageError(
          fmt::format("a plain marker's inner diameter is {:.2f} to {:.2f} of the "
                      "outer one, not {:.4g}",
                      kPlainInnerRatioMin, kPlainInnerRatioMax, ratio));
    }
    markers.push_back({{0, 0, ratio}, "plain", fmt::format("ratio {:.3f}", ratio)});
  } else {
    const NecklaceCode code(options.bits, options.hamming);
    const std::string ids = options.all ? fmt::format("1-{}", code.id_count()) : options.ids;
    for (const int id : parse_ids(ids, code.id_count())) {
      markers.push_back(code_marker(code, id));
    }
  }
  std::vector<PrintedMarker> copies;
  for (const PrintedMarker& marker : markers) {
    copies.insert(copies.end(), static_cast<std::size_t>(options.copies), marker);
  }
  return copies;
}

// Pages to be drawn, all of one size.
struct Document {
  PageSize size;
  std::vector<DrawPage> pages;
};

Document bare_document(const MarkersOptions& options, std::span<const PrintedMarker> markers) {
  Document document{bare_page(diameter_mm(options)), {}};
  for (const PrintedMarker& marker : markers) {
    document.pages.emplace_back([&options, &marker](cairo_t* context) {
      draw_bare_marker(context, marker, diameter_mm(options));
    });
  }
  return document;
}

Document sheet_document(const MarkersOptions& options, std::span<const PrintedMarker> markers) {
  const SheetLayout layout = lay_out_sheet(options.paper, diameter_mm(options));
  Document document{layout.page, {}};
  const auto cells = static_cast<std::size_t>(layout.cells());
  for (std::size_t first = 0; first < markers.size(); first += cells) {
    const auto part = markers.subspan(first, std::min(cells, markers.size() - first));
    document.pages.emplace_back([&options, layout, part](cairo_t* context) {
      draw_sheet(context, layout, diameter_mm(options), part);
    });
  }
  return document;
}

// The document keeps references to both arguments.
Document make_document(const MarkersOptions& options, std::span<const PrintedMarker> markers) {
  return bare(options) ? bare_document(options, markers) : sheet_document(options, markers);
}

// The board of the options, as large as the paper allows where they leave it open.
Board chosen_board(const MarkersOptions& options) {
  Board board;
  board.columns = options.columns;
  board.rows = options.rows;
  board.bits = options.bits;
  board.hamming = options.hamming;
  checked(board);  // before columns and rows are divided by
  if (options.spacing_m) {
    board.spacing_m = *options.spacing_m;
    board.diameter_m = kBoardDiameterRatio * board.spacing_m;
  } else {
    board = largest_board(options.paper, board);
  }
  if (options.given_diameter_m) board.diameter_m = *options.given_diameter_m;
  return checked(board);
}

Document board_document(const MarkersOptions& options) {
  const Board board = chosen_board(options);
  const SheetLayout layout = lay_out_board(options.paper, board);
  return {layout.page,
          {[layout, board](cairo_t* context) { draw_board_sheet(context, layout, board); }}};
}

double pixels_per_mm(const MarkersOptions& options, PageSize size) {
  const double density = options.pixels > 0
                             ? options.pixels / std::max(size.width_mm, size.height_mm)
                             : options.dpi / kMillimetresPerInch;
  const double longest = std::max(size.width_mm, size.height_mm) * density;
  if (longest > kMaxImageSide) {
    throw UsageError(fmt::format("a picture of {:.0f} pixels is too large, at most {}: lower --dpi",
                                 longest, kMaxImageSide));
  }
  return density;
}

// "sheet.svg" for the only page, else "sheet-01.svg" and so on.
std::string numbered(const std::filesystem::path& path, std::size_t page, std::size_t pages) {
  if (pages == 1) {
    return path.string();
  }
  const std::size_t width = fmt::format("{}", pages).size();
  return (path.parent_path() / fmt::format("{}-{:0{}}{}", path.stem().string(), page + 1, width,
                                           path.extension().string()))
      .string();
}

void write_document(const MarkersOptions& options, const Document& document,
                    const std::filesystem::path& path, const std::string& format) {
  if (format == "pdf") {
    write_pdf(path.string(), document.size, document.pages);
    return;
  }
  for (std::size_t i = 0; i < document.pages.size(); ++i) {
    const std::string name = numbered(path, i, document.pages.size());
    if (format == "svg") {
      write_svg(name, document.size, document.pages[i]);
    } else {
      write_png(name, document.size, pixels_per_mm(options, document.size), document.pages[i]);
    }
  }
}

// A file for every marker: "8bits_id07.svg", "plain.svg".
void write_directory(const MarkersOptions& options, std::span<const PrintedMarker> markers) {
  std::error_code error;
  std::filesystem::create_directories(options.output, error);
  if (error) {
    throw std::runtime_error(
        fmt::format("{} can't be created: {}", options.output, error.message()));
  }
  for (std::size_t i = 0; i < markers.size(); ++i) {
    std::string name = markers[i].set + "_" + markers[i].name;
    std::erase_if(name, [](char c) { return c == ' ' || c == ','; });
    if (options.copies > 1) {
      name += fmt::format("_{}", i % static_cast<std::size_t>(options.copies) + 1);
    }
    const Document document = make_document(options, markers.subspan(i, 1));
    write_document(options, document,
                   std::filesystem::path(options.output) / (name + "." + options.format),
                   options.format);
  }
}

std::string format_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension != ".pdf" && extension != ".svg" && extension != ".png") {
    throw UsageError(fmt::format(
        "{} names no known format: end it in .pdf, .svg or .png, or in / for a directory", path));
  }
  return extension.substr(1);
}

void make_board(const MarkersOptions& options) {
  if (bare(options)) {
    throw UsageError("a board needs a sheet: --paper A4, A3 or Letter, and --dpi for PNG files");
  }
  write_document(options, board_document(options), options.output, format_of(options.output));
}

void make_markers(MarkersOptions& options) {
  if (options.pixels > 0) {
    options.paper = "none";
  }
  options.diameter_m = options.given_diameter_m.value_or(kDefaultDiameter);
  try {
    if (options.board) {
      make_board(options);
      return;
    }
    const std::vector<PrintedMarker> markers = chosen_markers(options);
    if (options.output.ends_with('/') || std::filesystem::is_directory(options.output)) {
      write_directory(options, markers);
      return;
    }
    const std::string format = format_of(options.output);
    write_document(options, make_document(options, markers), options.output, format);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());  // options that contradict the code set or the paper
  }
}

}  // namespace

void add_markers(CLI::App& app) {
  auto* command = app.add_subcommand("markers", "Printable markers at exact scale");
  auto options = std::make_shared<MarkersOptions>();
  auto* which = command->add_option_group("which markers (one of)");
  which->add_option("--id,--ids", options->ids, "WhyCode ids: 7, or 1-4,9")->type_name("LIST");
  which->add_flag("--all", options->all, "Every id of the set");
  which
      ->add_option("--plain", options->plain_ratio,
                   "Plain WhyCon marker; RATIO of its inner to its outer diameter, 0.33 to 0.60 "
                   "(50/122 if left out)")
      ->expected(0, 1)
      ->default_str(fmt::format("{}", kPlainInnerRatio))
      ->type_name("RATIO");
  auto* board = which->add_flag("--board", options->board,
                                "The board that roundel calibrate camera wants, on one sheet");
  which->require_option(1);
  command->add_option("--columns", options->columns, "Of the board")
      ->needs(board)
      ->capture_default_str();
  command->add_option("--rows", options->rows, "Of the board")->needs(board)->capture_default_str();
  command
      ->add_option("--spacing", options->spacing_m,
                   "Of the board, between the centres of neighbours, metres; as large as fits if "
                   "left out")
      ->needs(board)
      ->check(CLI::Range(kMinDiameter, kMaxDiameter))
      ->type_name("METRES");
  command->add_option("--bits", options->bits, "WhyCode bits, 2 to 16")->capture_default_str();
  command->add_option("--hamming", options->hamming, "Minimum Hamming distance of the set, 1 to 4")
      ->capture_default_str();
  command
      ->add_option("--diameter", options->given_diameter_m,
                   "Outer black diameter, metres; on a board 0.75 of the spacing if left out")
      ->check(CLI::Range(kMinDiameter, kMaxDiameter))
      ->default_str(fmt::format("{}", kDefaultDiameter))
      ->type_name("METRES");
  command->add_option("--copies", options->copies, "Of every marker")
      ->check(CLI::Range(1, kMaxCopies))
      ->capture_default_str();
  command
      ->add_option("--paper", options->paper,
                   "A4, A3, Letter: sheets with cut lines, ids and a ruler; none: the marker alone "
                   "with its white margin")
      ->capture_default_str();
  command
      ->add_option("-o,--output", options->output,
                   "FILE.pdf, .svg or .png (numbered if it takes several), or DIRECTORY/ for one "
                   "file a marker")
      ->required()
      ->type_name("FILE");
  command->add_option("--format", options->format, "Of the files in a directory")
      ->check(CLI::IsMember({"pdf", "svg", "png"}))
      ->capture_default_str();
  command->add_option("--dpi", options->dpi, "Pixels per inch of PNG files")
      ->check(CLI::Range(10.0, 2400.0))
      ->capture_default_str();
  command
      ->add_option("--pixels", options->pixels,
                   "Side of a PNG of the marker alone, with its white margin; instead of --dpi")
      ->check(CLI::Range(16, kMaxImageSide));
  command->callback([options] { make_markers(*options); });
}

}  // namespace roundel
