#include "bench/accuracy/false_positives.hpp"

#include <fmt/ostream.h>

#include <filesystem>
#include <fstream>

#include "bench/accuracy/distractors.hpp"
#include "bench/accuracy/judge.hpp"
#include "core/detector.hpp"

namespace roundel::bench {

namespace {

constexpr int kKeptPictures = 5;  // of a kind

void write_pgm(const std::filesystem::path& path, const GreyImage& picture) {
  std::ofstream file(path, std::ios::binary);
  fmt::print(file, "P5\n{} {}\n255\n", picture.width, picture.height);
  file.write(reinterpret_cast<const char*>(picture.pixels.data()),
             static_cast<std::streamsize>(picture.pixels.size()));
}

}  // namespace

void write_false_positives(std::ostream& markdown, int pictures, const std::string& folder) {
  fmt::print(markdown, R"(# False markers

Written by `bench/run-accuracy`; do not edit. Pictures without a marker, shown to the detector with default
parameters and a camera: the arena's floor in Full HD with noise 3 and blur 0.7, all else 640 × 480 with noise
0, 3 or 10. Without an id means: taken for a plain WhyCon marker.

| pictures of | number | with a false marker | markers without id | with id | with id, sure (p ≥ {}) |
|---|--:|--:|--:|--:|--:|
)",
             kSure);
  int all = 0, all_false = 0, kind = 0;
  GreyImage picture;
  for (const auto& distractor : all_distractors()) {
    Detector detector(DetectorParameters{}, distractor->camera());
    int false_pictures = 0, plain = 0, named = 0, sure = 0;
    for (int number = 0; number < pictures; ++number) {
      distractor->draw(static_cast<std::uint64_t>(number), picture);
      const auto markers = detector.detect(picture.view());
      if (!markers.empty() && ++false_pictures <= kKeptPictures && !folder.empty()) {
        write_pgm(std::filesystem::path(folder) / fmt::format("false-{}-{}.pgm", kind, number),
                  picture);
      }
      for (const Marker& marker : markers) {
        ++(marker.id > 0 ? named : plain);
        if (marker.id > 0 && marker.id_probability >= kSure) ++sure;
      }
    }
    ++kind;
    all += pictures;
    all_false += false_pictures;
    fmt::print(markdown, "| {} | {} | {} | {} | {} | {} |\n", distractor->name(), pictures,
               false_pictures, plain, named, sure);
  }
  fmt::print(markdown, "\n{} of {} pictures show a false marker; the target is 0 of 10000: {}.\n",
             all_false, all,
             all_false > 0  ? "**missed**"
             : all >= 10000 ? "met"
                            : "none so far, but too few pictures");
}

}  // namespace roundel::bench
