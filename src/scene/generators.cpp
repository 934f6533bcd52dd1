#include "scene/generators.hpp"

namespace fw::scene {

const std::vector<GeneratorInfo>& generators() {
  static const std::vector<GeneratorInfo> list = {
      {"chain", "Points on a line", "springs between neighbours (structural) and next neighbours (bend)"},
      {"cloth", "Rectangular sheet", "structural, shear and bend springs on a lattice of N x M points"},
      {"grid", "Three-dimensional lattice",
       "structural, shear, bend and cross-brace springs on N x M x L points"},
      {"block", "Solid block of tetrahedra",
       "cells cut into six tetrahedra each; every edge is a spring, masses from density"},
  };
  return list;
}

}  // namespace fw::scene
