#include "core/id_evidence.hpp"

#include <doctest/doctest.h>

using roundel::IdEvidence;

TEST_CASE("a track without readings has no name") {
  const IdEvidence evidence;
  CHECK(evidence.best(30).id == -1);
  CHECK(evidence.best(30).probability == 0);
}

TEST_CASE("one good reading names a track with about that reading's probability") {
  IdEvidence evidence;
  evidence.add(7, 0.97, 30);
  CHECK(evidence.best(30).id == 7);
  CHECK(evidence.best(30).probability == doctest::Approx(0.97).epsilon(0.01));
}

TEST_CASE("doubtful readings of one id add up to certainty") {
  IdEvidence evidence;
  for (int frame = 0; frame < 10; ++frame) evidence.add(12, 0.6, 30);
  CHECK(evidence.best(30).id == 12);
  CHECK(evidence.best(30).probability > 0.999);
}

TEST_CASE("one bad frame changes nobody's name") {
  IdEvidence evidence;
  for (int frame = 0; frame < 5; ++frame) evidence.add(3, 0.99, 30);
  evidence.add(4, 0.999, 30);
  CHECK(evidence.best(30).id == 3);
  CHECK(evidence.best(30).probability > 0.9);
}

TEST_CASE("a name that all later frames contradict is given up") {
  IdEvidence evidence;
  for (int frame = 0; frame < 1000; ++frame) evidence.add(3, 0.999, 30);
  int frames = 0;
  while (evidence.best(30).id != 4 && frames < 60) {
    evidence.add(4, 0.999, 30);
    ++frames;
  }
  CHECK(frames < 30);
}

TEST_CASE("readings without an id change nothing") {
  IdEvidence evidence;
  evidence.add(5, 0.99, 30);
  const double before = evidence.best(30).probability;
  evidence.add(-1, 0, 30);
  CHECK(evidence.best(30).probability == before);
}
