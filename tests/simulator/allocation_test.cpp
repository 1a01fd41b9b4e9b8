#include <doctest/doctest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "simulator/arena.hpp"

namespace {

std::atomic<long> allocations{0};

void* counted(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) {
  return counted(size);
}
void* operator new[](std::size_t size) {
  return counted(size);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}

TEST_CASE("rendering frame after frame allocates nothing once it is warm") {
  roundel::ArenaOptions options;
  options.image_width = 960;
  options.image_height = 540;
  options.occluder = true;
  roundel::Arena arena(options);
  roundel::GreyImage image;
  std::int64_t frame = 0;
  for (; frame < 10; ++frame) arena.render(frame, image);
  const long before = allocations;
  CHECK(before > 0);  // the counter counts
  for (; frame < 200; ++frame) {
    arena.render(frame, image);
    arena.truth(frame);
  }
  CHECK(allocations == before);
}
