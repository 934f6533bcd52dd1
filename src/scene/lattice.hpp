#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "mechanics/grid.hpp"
#include "mechanics/mass_spring_model.hpp"

namespace fw::scene {

/// A regular arrangement of points: a line, a sheet or a box. Point (i, j, k) has the index
/// i + counts[0]·(j + counts[1]·k) and lies at origin + Σ_a extent[a]·(i_a/(counts[a] − 1)).
struct Lattice {
  std::array<int, 3> counts{1, 1, 1};    ///< points along each axis, ≥ 1
  Vec3<double> origin{};                 ///< of point (0, 0, 0) [m]
  std::array<Vec3<double>, 3> extent{};  ///< from the first to the last point along each axis [m]

  mechanics::Grid grid() const { return {counts}; }
  int index(int i, int j, int k) const { return grid().index(i, j, k); }
  std::size_t point_count() const;
};

/// Springs of one kind: each joins point (i, j, k) to (i, j, k) + offset wherever both exist. No offset may
/// be the negative of another, so that every spring is there once.
struct SpringFamily {
  std::vector<std::array<int, 3>> offsets;
  double stiffness = 0.0;
  double damping = 0.0;
};

/// Neighbours along the axes.
std::vector<std::array<int, 3>> structural_offsets();
/// Both diagonals of every face.
std::vector<std::array<int, 3>> shear_offsets();
/// Next but one along the axes.
std::vector<std::array<int, 3>> bend_offsets();
/// The four body diagonals of every cell.
std::vector<std::array<int, 3>> cross_brace_offsets();
/// The edges of the tetrahedra into which Kuhn's subdivision cuts every cell: one tetrahedron
/// (0, e_a, e_a + e_b, (1,1,1)) per permutation (a, b, c) of the axes; neighbouring cells conform.
std::vector<std::array<int, 3>> kuhn_edge_offsets();

/// How many springs `lattice_springs` would make; in floating point, so that no input overflows it.
double count_springs(const std::array<int, 3>& counts, const std::vector<SpringFamily>& families);

/// 3n coordinates.
Vector lattice_positions(const Lattice& lattice);

/// Springs point by point (near in memory to their points), each with rest length `rest_length_factor` ×
/// distance.
mechanics::Springs lattice_springs(const Lattice& lattice, const Vector& position,
                                   const std::vector<SpringFamily>& families, mechanics::SpringLaw law,
                                   double rest_length_factor);

/// The length, area or volume that the lattice covers, over the axes with more than one point.
double covered_measure(const Lattice& lattice);

/// One mass per point when each cell's mass (density × length, area or volume) is shared equally by its
/// corners.
std::vector<double> cell_lumped_masses(const Lattice& lattice, double density);

/// One mass per point when the mass (density × volume) of each tetrahedron of Kuhn's subdivision is shared
/// equally by its four vertices [Zachmann 2011, S35]. Every axis needs at least two points.
std::vector<double> tetrahedron_lumped_masses(const Lattice& lattice, double density);

}  // namespace fw::scene
