#pragma once

#include <chrono>
#include <future>
#include <memory>
#include <stdexcept>

#include "daemon/control/loop_commands.hpp"

namespace roundel {

// Runs something on the frame loop's thread and waits for what it returns. Throws
// std::runtime_error if the loop does not come to it, std::future_error if it has ended.
template <typename Call>
auto ask_loop(LoopCommands& loop, Call call) -> decltype(call(std::declval<LoopControl&>())) {
  constexpr auto kPatience = std::chrono::seconds(10);  // a reload may read many files
  using Result = decltype(call(std::declval<LoopControl&>()));
  // Shared: if nobody waits any more, the result goes nowhere.
  auto promise = std::make_shared<std::promise<Result>>();
  std::future<Result> future = promise->get_future();
  loop.post([promise = std::move(promise), call](LoopControl& control) {
    promise->set_value(call(control));
  });
  if (future.wait_for(kPatience) != std::future_status::ready) {
    throw std::runtime_error("roundeld is busy");
  }
  return future.get();
}

}  // namespace roundel
