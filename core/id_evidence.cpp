#include "core/id_evidence.hpp"

#include <algorithm>
#include <cmath>

namespace roundel {

namespace {

// Share of readings that are wrong in a way that their own probability does not tell.
constexpr double kUnexplained = 1e-3;
// What disturbs one frame mostly disturbs the next one too: further frames count less than the
// first.
constexpr double kFurtherFrames = 0.4;
// Certainty has an end, so that a wrong name can be corrected in a second or so.
constexpr double kMaxLogOdds = 16;

}  // namespace

void IdEvidence::add(int id, double probability, int id_count) {
  if (id < 1) return;
  const double any_other = 1.0 / std::max(1, id_count - 1);
  const double read = (1 - kUnexplained) * probability + kUnexplained / id_count;
  const double not_read =
      (1 - kUnexplained) * (1 - probability) * any_other + kUnexplained / id_count;
  const double gain = std::log(read / not_read) * (first_ ? 1.0 : kFurtherFrames);
  first_ = false;

  auto known = std::find_if(candidates_.begin(), candidates_.end(),
                            [id](const Candidate& c) { return c.id == id; });
  if (known == candidates_.end()) {
    known = std::min_element(
        candidates_.begin(), candidates_.end(),
        [](const Candidate& a, const Candidate& b) { return a.log_odds < b.log_odds; });
    *known = {id, 0};
  }
  known->log_odds = std::max(0.0, known->log_odds + gain);
  // When one reaches the limit, the others' distance to it is kept by lowering them.
  const double excess = known->log_odds - kMaxLogOdds;
  if (excess > 0) {
    for (Candidate& candidate : candidates_) {
      candidate.log_odds = std::max(0.0, candidate.log_odds - excess);
    }
  }
}

IdEvidence::Name IdEvidence::best(int id_count) const {
  Name name;
  double highest = 0, total = 0;
  int listed = 0;
  for (const Candidate& candidate : candidates_) {
    if (candidate.id < 0) continue;
    ++listed;
    const double odds = std::exp(candidate.log_odds);
    total += odds;
    if (odds > highest) {
      highest = odds;
      name.id = candidate.id;
    }
  }
  if (name.id > 0) name.probability = highest / (total + std::max(0, id_count - listed));
  return name;
}

}  // namespace roundel
