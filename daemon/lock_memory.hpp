#pragma once

namespace roundel {

// Keeps this process's memory, also what it will take later, from being swapped out; a warning in
// the log if it can't.
void lock_memory();

}  // namespace roundel
