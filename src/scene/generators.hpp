#pragma once

#include <string>
#include <vector>

namespace fw::scene {

/// A standard system that `[generate] kind = "…"` builds.
struct GeneratorInfo {
  std::string name;
  std::string title;
  std::string description;
};

/// Every kind of generated system.
const std::vector<GeneratorInfo>& generators();

}  // namespace fw::scene
