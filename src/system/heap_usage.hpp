#pragma once

#include <cstddef>

namespace fw {

/// Bytes that the program has allocated and not given back, over all threads, foreign libraries included. The
/// difference of two calls is what was kept between them, if nothing else was running. By glibc's allocator;
/// under the address sanitizer it is 0.
std::size_t heap_usage();

}  // namespace fw
