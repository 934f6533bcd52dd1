#include <cstdio>

#include "core/provenance.hpp"

int main() { std::puts(fw::version().c_str()); }
