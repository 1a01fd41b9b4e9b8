// make_film FILE: the film that the lab's cameras show, and what the tracker makes of it directly.
#include <cstdio>
#include <exception>

#include "tests/lab/film.hpp"

int main(int argc, char** argv) {
  constexpr int kPictures = 30;
  if (argc != 2) {
    std::fputs("usage: make_film FILE\n", stderr);
    return 2;
  }
  try {
    roundel::Film::made(kPictures).write(argv[1]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_film: %s\n", error.what());
    return 1;
  }
}
