#pragma once

#include <atomic>

namespace fw::app {

/// Turns SIGINT and SIGTERM into a flag, so that what is finished can be kept. A second signal ends the
/// program at once. SIGPIPE and SIGXFSZ are ignored: the write that caused them fails and is reported.
const std::atomic<bool>& install_interrupt_flag();

}  // namespace fw::app
