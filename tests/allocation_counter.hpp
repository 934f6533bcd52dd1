#pragma once

// Counts every memory allocation of the program. Include it in one source file of a test program only.

#include <atomic>
#include <cstdlib>

namespace {
std::atomic<std::size_t> allocations{0};
}

// Both operator new and Eigen come down to malloc. The address sanitizer's own offers a hook; glibc's may be
// replaced by the program and stays reachable under another name.
#if defined(__SANITIZE_ADDRESS__)
// Declared here since not every compiler installs its header; see <sanitizer/allocator_interface.h>.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*on_malloc)(const volatile void*, std::size_t),
                                                         void (*on_free)(const volatile void*));
namespace {
[[maybe_unused]] const int hook = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void*, std::size_t) { allocations.fetch_add(1, std::memory_order_relaxed); },
    [](const volatile void*) {});
}
#else
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  return __libc_malloc(size);
}
#endif

namespace fw {

/// How many allocations `action` makes, by operator new, Eigen or C code.
template <class Action>
std::size_t allocations_of(Action action) {
  const std::size_t before = allocations.load();
  action();
  return allocations.load() - before;
}

}  // namespace fw
