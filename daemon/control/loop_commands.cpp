#include "daemon/control/loop_commands.hpp"

#include <utility>

namespace roundel {

void LoopCommands::post(LoopCommand command) {
  {
    const std::lock_guard lock(mutex_);
    if (dropping_) return;
    waiting_.push_back(std::move(command));
  }
  wakeup_.wake();
}

void LoopCommands::run(LoopControl& loop) {
  std::vector<LoopCommand> commands;
  {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) return;  // the descriptor stays readable
    wakeup_.clear();
    commands.swap(waiting_);
  }
  for (const LoopCommand& command : commands) command(loop);
}

void LoopCommands::drop_all() {
  std::vector<LoopCommand> commands;
  const std::lock_guard lock(mutex_);
  dropping_ = true;
  commands.swap(waiting_);
}

}  // namespace roundel
