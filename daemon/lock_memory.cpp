#include "daemon/lock_memory.hpp"

#include <sys/mman.h>

#include <cerrno>
#include <cstring>

#include "daemon/log.hpp"

namespace roundel {

// Pages are locked as they are used: the stacks of threads are mostly never touched.
void lock_memory() {
  if (::mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0) return;
  log_warning("memory can't be locked: {} (systemd: LimitMEMLOCK=infinity; a shell: ulimit -l)",
              std::strerror(errno));
}

}  // namespace roundel
