#include "system/heap_usage.hpp"

#include <malloc.h>

namespace fw {

std::size_t heap_usage() {
  const struct mallinfo2 usage = mallinfo2();
  return usage.uordblks + usage.hblkhd;
}

}  // namespace fw
