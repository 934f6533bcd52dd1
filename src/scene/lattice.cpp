#include "scene/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace fw::scene {
namespace {

using Offset = std::array<int, 3>;

double fraction(int i, int count) {
  return count > 1 ? static_cast<double>(i) / (count - 1) : 0.0;
}

}  // namespace

std::size_t Lattice::point_count() const {
  return static_cast<std::size_t>(counts[0]) * static_cast<std::size_t>(counts[1]) *
         static_cast<std::size_t>(counts[2]);
}

std::vector<Offset> structural_offsets() {
  return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
}

std::vector<Offset> shear_offsets() {
  return {{1, 1, 0}, {-1, 1, 0}, {1, 0, 1}, {-1, 0, 1}, {0, 1, 1}, {0, -1, 1}};
}

std::vector<Offset> bend_offsets() {
  return {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
}

std::vector<Offset> cross_brace_offsets() {
  return {{1, 1, 1}, {-1, 1, 1}, {1, -1, 1}, {-1, -1, 1}};
}

std::vector<Offset> kuhn_edge_offsets() {
  return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
}

double count_springs(const std::array<int, 3>& counts, const std::vector<SpringFamily>& families) {
  double total = 0.0;
  for (const SpringFamily& family : families) {
    for (const Offset& offset : family.offsets) {
      double product = 1.0;
      for (std::size_t a = 0; a < 3; ++a)
        product *= std::max(0.0, static_cast<double>(counts[a]) - std::abs(offset[a]));
      total += product;
    }
  }
  return total;
}

Vector lattice_positions(const Lattice& lattice) {
  Vector position(3 * static_cast<Index>(lattice.point_count()));
  lattice.grid().for_each_point([&](int i, int j, int k) {
    const Vec3<double> x = lattice.origin + fraction(i, lattice.counts[0]) * lattice.extent[0] +
                           fraction(j, lattice.counts[1]) * lattice.extent[1] +
                           fraction(k, lattice.counts[2]) * lattice.extent[2];
    store3(position.data(), lattice.index(i, j, k), x);
  });
  return position;
}

mechanics::Springs lattice_springs(const Lattice& lattice, const Vector& position,
                                   const std::vector<SpringFamily>& families, mechanics::SpringLaw law,
                                   double rest_length_factor) {
  mechanics::Springs springs;
  springs.law = law;
  const auto count = static_cast<std::size_t>(count_springs(lattice.counts, families));
  springs.first.reserve(count);
  springs.second.reserve(count);
  springs.stiffness.reserve(count);
  springs.damping.reserve(count);
  springs.rest_length.reserve(count);
  const mechanics::Grid grid = lattice.grid();
  grid.for_each_point([&](int i, int j, int k) {
    const int first = grid.index(i, j, k);
    const auto x = load3(position.data(), first);
    for (const SpringFamily& family : families) {
      for (const Offset& offset : family.offsets) {
        const int second = grid.neighbour(i, j, k, offset);
        if (second < 0) continue;
        const double length = norm(load3(position.data(), second) - x);
        springs.add(first, second, {family.stiffness, family.damping, rest_length_factor * length});
      }
    }
  });
  return springs;
}

double covered_measure(const Lattice& lattice) {
  double measure = 1.0;
  for (std::size_t a = 0; a < 3; ++a) {
    if (lattice.counts[a] > 1) measure *= norm(lattice.extent[a]);
  }
  return measure;
}

std::vector<double> cell_lumped_masses(const Lattice& lattice, double density) {
  double cell_mass = density;
  for (std::size_t a = 0; a < 3; ++a) {
    if (lattice.counts[a] > 1) cell_mass *= norm(lattice.extent[a]) / (lattice.counts[a] - 1);
  }
  // A point has half a cell along every axis on whose end it lies.
  const auto share = [&](int i, std::size_t a) {
    const int n = lattice.counts[a];
    return n > 1 && (i == 0 || i == n - 1) ? 0.5 : 1.0;
  };
  std::vector<double> mass;
  mass.reserve(lattice.point_count());
  lattice.grid().for_each_point(
      [&](int i, int j, int k) { mass.push_back(cell_mass * share(i, 0) * share(j, 1) * share(k, 2)); });
  return mass;
}

std::vector<double> tetrahedron_lumped_masses(const Lattice& lattice, double density) {
  const auto& n = lattice.counts;
  std::array<Vec3<double>, 3> edge;
  for (std::size_t a = 0; a < 3; ++a) edge[a] = (1.0 / (n[a] - 1)) * lattice.extent[a];
  // All six tetrahedra of a cell have the same volume |det(e_0, e_1, e_2)|/6.
  const double quarter = density * std::abs(dot(edge[0], cross(edge[1], edge[2]))) / 6.0 / 4.0;
  std::vector<double> mass(lattice.point_count(), 0.0);
  mechanics::Grid{{n[0] - 1, n[1] - 1, n[2] - 1}}.for_each_point([&](int i, int j, int k) {
    std::array<std::size_t, 3> axes{0, 1, 2};
    do {
      std::array<int, 3> corner{i, j, k};
      mass[static_cast<std::size_t>(lattice.index(corner[0], corner[1], corner[2]))] += quarter;
      for (const std::size_t axis : axes) {
        ++corner[axis];
        mass[static_cast<std::size_t>(lattice.index(corner[0], corner[1], corner[2]))] += quarter;
      }
    } while (std::next_permutation(axes.begin(), axes.end()));
  });
  return mass;
}

}  // namespace fw::scene
