#pragma once

#include <array>

namespace roundel {

// The name of a track, by the evidence of all its frames (METHOD.md section 5): log-odds of the few
// ids that were read, against any id that was not. One bad frame changes nobody's name.
class IdEvidence {
 public:
  struct Name {
    int id = -1;
    double probability = 0;
  };

  // Adds a frame's reading: `id` in [1, id_count] with its probability given that frame alone.
  void add(int id, double probability, int id_count);

  // The likeliest id; id -1 while nothing has been read.
  Name best(int id_count) const;

 private:
  struct Candidate {
    int id = -1;
    double log_odds = 0;
  };
  std::array<Candidate, 4> candidates_;
  bool first_ = true;
};

}  // namespace roundel
