#include "scene/lattice.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <numeric>
#include <set>

#include "scene/scene.hpp"
#include "scene_comparison.hpp"

namespace fw::scene {
namespace {

Scene cloth_of(int n) {
  return parse_scene(
      fmt::format("[generate]\nkind = 'cloth'\ncounts = [{}, {}]\nspacing = 0.1\ntotal_mass = 1\n"
                  "stiffness = {{ structural = 3.0, shear = 2.0, bend = 1.0 }}\n",
                  n, n),
      "cloth.toml");
}

std::size_t count_with_stiffness(const mechanics::Springs& springs, double stiffness) {
  return static_cast<std::size_t>(std::count(springs.stiffness.begin(), springs.stiffness.end(), stiffness));
}

using Edge = std::pair<int, int>;

std::set<Edge> edges_of(const mechanics::Springs& springs) {
  std::set<Edge> edges;
  for (std::size_t k = 0; k < springs.size(); ++k) {
    edges.insert(std::minmax(springs.first[k], springs.second[k]));
  }
  return edges;
}

TEST(Cloth, HasTheSpringsOfTheFormulas) {
  for (const int n : {2, 3, 10, 100}) {
    SCOPED_TRACE(n);
    const auto& springs = cloth_of(n).model.springs;
    const auto m = static_cast<std::size_t>(n);
    EXPECT_EQ(count_with_stiffness(springs, 3.0), 2 * m * (m - 1));
    EXPECT_EQ(count_with_stiffness(springs, 2.0), 2 * (m - 1) * (m - 1));
    EXPECT_EQ(count_with_stiffness(springs, 1.0), 2 * m * (m - 2));
    EXPECT_EQ(edges_of(springs).size(), springs.size()) << "every spring once";
  }
  EXPECT_EQ(cloth_of(100).model.springs.size(), 59002u);
  EXPECT_EQ(cloth_of(500).model.springs.size(), 1495002u);
}

TEST(Cloth, WithAMillionParticlesIsBuiltInSeconds) {
  const auto start = std::chrono::steady_clock::now();
  const Scene scene = cloth_of(1000);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(scene.model.mass.size(), 1000000u);
  EXPECT_EQ(scene.model.springs.size(), 5990002u);
  EXPECT_EQ(scene.model.springs.first.capacity(), 5990002u) << "memory is taken once, exactly";
  EXPECT_LT(scene.resolved_toml.size(), 1000u);
  EXPECT_LT(elapsed.count(), 10.0);
}

TEST(Cloth, LiesInItsPlaneWithTheFirstAxisRightAndTheSecondUp) {
  for (const auto& [plane, u, v] : {std::tuple{"xy", 0, 1}, std::tuple{"xz", 0, 2}, std::tuple{"yz", 1, 2}}) {
    SCOPED_TRACE(plane);
    const Scene scene =
        parse_scene(fmt::format("[generate]\nkind = 'cloth'\ncounts = [3, 5]\nsize = [2.0, 8.0]\n"
                                "plane = '{}'\norigin = [10, 20, 30]\nmass = 0.5\nstiffness = 1\n",
                                plane),
                    "a.toml");
    ASSERT_EQ(scene.position.size(), 45);
    Vector expected = (Vector(3) << 10, 20, 30).finished();
    EXPECT_EQ(scene.position.head(3), expected);
    expected[u] += 1.0;  // particle 1: next along the first axis
    EXPECT_EQ(scene.position.segment(3, 3), expected);
    expected[u] += 1.0;
    expected[v] += 8.0;  // the last one
    EXPECT_EQ(scene.position.tail(3), expected);
    EXPECT_EQ(scene.model.mass, std::vector<double>(15, 0.5));
  }
}

TEST(Cloth, SharesEachCellsMassByItsCorners) {
  const Scene scene = parse_scene(
      "[generate]\nkind = 'cloth'\ncounts = [3, 3]\nsize = [2.0, 4.0]\ndensity = 3.0\nstiffness = 1\n",
      "a.toml");
  // A cell of 1 m × 2 m has 6 kg, so a corner has 1.5 kg, an edge point 3 kg, the centre 6 kg.
  EXPECT_EQ(scene.model.mass, (std::vector<double>{1.5, 3, 1.5, 3, 6, 3, 1.5, 3, 1.5}));
  const Scene total = parse_scene(
      "[generate]\nkind = 'cloth'\ncounts = [3, 3]\nsize = [2.0, 4.0]\ntotal_mass = 24.0\nstiffness = 1\n",
      "a.toml");
  EXPECT_EQ(total.model.mass, scene.model.mass);
}

TEST(Chain, RunsAlongItsDirection) {
  const Scene scene = parse_scene(
      "[generate]\nkind = 'chain'\ncount = 5\nlength = 10.0\ndirection = [3, 0, 4]\norigin = [1, 1, 1]\n"
      "density = 2.0\nsprings = ['structural', 'bend']\nstiffness = { structural = 5, bend = 6 }\n"
      "damping = { bend = 0.25 }\nrest_length_factor = 0.5\nlaw = 'strain'\nvelocity = [0, 1, 0]\npinned = "
      "['start', 2]\n",
      "a.toml");
  EXPECT_NEAR(scene.position[12], 7.0, 1e-14);
  EXPECT_NEAR(scene.position[14], 9.0, 1e-14);
  EXPECT_EQ(scene.position[13], 1.0);
  const auto& mass = scene.model.mass;
  ASSERT_EQ(mass.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(mass[i], i % 4 == 0 ? 2.5 : 5.0, 1e-14);
  const auto& springs = scene.model.springs;
  EXPECT_EQ(springs.first, (std::vector<int>{0, 0, 1, 1, 2, 2, 3}));
  EXPECT_EQ(springs.second, (std::vector<int>{1, 2, 2, 3, 3, 4, 4}));
  EXPECT_EQ(springs.stiffness, (std::vector<double>{5, 6, 5, 6, 5, 6, 5}));
  EXPECT_EQ(springs.damping, (std::vector<double>{0, 0.25, 0, 0.25, 0, 0.25, 0}));
  for (std::size_t k = 0; k < springs.size(); ++k) {
    EXPECT_NEAR(springs.rest_length[k], 1.25 * (springs.second[k] - springs.first[k]), 1e-14);
  }
  EXPECT_EQ(springs.law, mechanics::SpringLaw::strain);
  EXPECT_EQ(scene.model.fixed, (std::vector<int>{0, 2}));
  EXPECT_EQ(scene.velocity, (Vector(15) << 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0).finished());
}

TEST(Chain, IsInEquilibriumWithItsDefaultRestLengths) {
  const Scene scene = parse_scene(
      "[generate]\nkind = 'chain'\ncount = 7\nspacing = 0.3\ndirection = [1, 2, 3]\nmass = 1\nstiffness = "
      "1e6\n",
      "a.toml");
  for (std::size_t k = 0; k < scene.model.springs.size(); ++k) {
    const auto d = load3(scene.position.data(), scene.model.springs.second[k]) -
                   load3(scene.position.data(), scene.model.springs.first[k]);
    EXPECT_EQ(norm(d), scene.model.springs.rest_length[k])
        << "no force at all at the start, not even by rounding";
  }
}

TEST(Grid, HasTheSpringsOfTheFormulas) {
  const std::map<std::string, std::size_t> expected = {
      {"structural", 2 * 4 * 5 + 3 * 3 * 5 + 3 * 4 * 4},   // Σ over axes of (n_a − 1) n_b n_c
      {"shear", 2 * (2 * 3 * 5 + 2 * 4 * 4 + 3 * 3 * 4)},  // two per face
      {"bend", 1 * 4 * 5 + 3 * 2 * 5 + 3 * 4 * 3},         // Σ over axes of (n_a − 2) n_b n_c
      {"cross_brace", 4 * 2 * 3 * 4},                      // four per cell
  };
  for (const auto& [family, count] : expected) {
    const Scene scene =
        parse_scene(fmt::format("[generate]\nkind = 'grid'\ncounts = [3, 4, 5]\nsize = [2, 3, 4]\n"
                                "mass = 1\nsprings = ['{}']\nstiffness = 1\n",
                                family),
                    "a.toml");
    EXPECT_EQ(scene.model.springs.size(), count) << family;
    EXPECT_EQ(edges_of(scene.model.springs).size(), count) << family;
    const double length = family == "structural" ? 1.0
                          : family == "shear"    ? std::sqrt(2.0)
                          : family == "bend"     ? 2.0
                                                 : std::sqrt(3.0);
    for (const double l : scene.model.springs.rest_length) EXPECT_NEAR(l, length, 1e-14);
  }
}

/// The tetrahedra of Kuhn's subdivision by its definition: in every cell, the points x with x_a ≥ x_b ≥ x_c.
std::vector<std::array<int, 4>> kuhn_tetrahedra(const Lattice& lattice) {
  std::vector<std::array<int, 4>> result;
  const std::array<std::array<int, 3>, 6> orders = {
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  for (int k = 0; k + 1 < lattice.counts[2]; ++k) {
    for (int j = 0; j + 1 < lattice.counts[1]; ++j) {
      for (int i = 0; i + 1 < lattice.counts[0]; ++i) {
        for (const auto& order : orders) {
          std::array<int, 3> c{i, j, k};
          std::array<int, 4> tetrahedron{};
          tetrahedron[0] = lattice.index(c[0], c[1], c[2]);
          for (std::size_t s = 0; s < 3; ++s) {
            ++c[static_cast<std::size_t>(order[s])];
            tetrahedron[s + 1] = lattice.index(c[0], c[1], c[2]);
          }
          result.push_back(tetrahedron);
        }
      }
    }
  }
  return result;
}

TEST(Block, ConsistsOfTheEdgesAndMassesOfConformingTetrahedra) {
  const Scene scene = parse_scene(
      "[generate]\nkind = 'block'\ncounts = [3, 4, 2]\nsize = [1.0, 0.9, 0.7]\ndensity = 800.0\nstiffness = "
      "1\n",
      "a.toml");
  const Lattice lattice{{3, 4, 2}, {}, {}};
  const auto tetrahedra = kuhn_tetrahedra(lattice);
  std::set<Edge> edges;
  std::map<std::array<int, 3>, int> faces;
  std::vector<double> mass(24, 0.0);
  double volume = 0.0;
  for (const auto& t : tetrahedra) {
    std::array<Vec3<double>, 4> x;
    for (std::size_t a = 0; a < 4; ++a) x[a] = load3(scene.position.data(), t[a]);
    const double v = std::abs(dot(x[1] - x[0], cross(x[2] - x[0], x[3] - x[0]))) / 6.0;
    volume += v;
    for (std::size_t a = 0; a < 4; ++a) {
      mass[static_cast<std::size_t>(t[a])] += 800.0 * v / 4.0;
      for (std::size_t b = a + 1; b < 4; ++b) edges.insert(std::minmax(t[a], t[b]));
      std::array<int, 3> face{t[(a + 1) % 4], t[(a + 2) % 4], t[(a + 3) % 4]};
      std::sort(face.begin(), face.end());
      ++faces[face];
    }
  }
  EXPECT_NEAR(volume, 0.63, 1e-14);
  EXPECT_EQ(edges_of(scene.model.springs), edges);
  EXPECT_EQ(scene.model.springs.size(), edges.size()) << "every edge once";
  for (std::size_t i = 0; i < mass.size(); ++i) EXPECT_NEAR(scene.model.mass[i], mass[i], 1e-11) << i;
  const auto& m = scene.model.mass;
  EXPECT_NEAR(std::accumulate(m.begin(), m.end(), 0.0), 800.0 * 0.63, 1e-10);
  // Neighbouring cells conform: a face belongs to two tetrahedra, or lies on the surface (two per boundary
  // square).
  std::size_t surface = 0;
  for (const auto& [face, uses] : faces) {
    EXPECT_LE(uses, 2);
    if (uses == 1) ++surface;
  }
  EXPECT_EQ(surface, 2u * 2u * (2 * 3 + 2 * 1 + 3 * 1));
}

TEST(PinnedPoints, HaveNames) {
  const auto pinned = [](const std::string& kind, const std::string& names) {
    const std::string counts = kind == "chain"   ? "count = 4\nspacing = 1\n"
                               : kind == "cloth" ? "counts = [3, 4]\nspacing = 1\n"
                                                 : "counts = [3, 3, 3]\nspacing = 1\n";
    return parse_scene(
               "[generate]\nkind = '" + kind + "'\n" + counts + "mass = 1\nstiffness = 1\npinned = " + names,
               "a.toml")
        .model.fixed;
  };
  using Points = std::vector<int>;
  EXPECT_EQ(pinned("chain", "'start'"), (Points{0}));
  EXPECT_EQ(pinned("chain", "'end'"), (Points{3}));
  EXPECT_EQ(pinned("chain", "'ends'"), (Points{0, 3}));
  EXPECT_EQ(pinned("chain", "2"), (Points{2}));
  EXPECT_EQ(pinned("chain", "['ends', 2, 0]"), (Points{0, 2, 3})) << "the union, sorted";
  EXPECT_EQ(pinned("chain", "'all'"), (Points{0, 1, 2, 3}));
  EXPECT_EQ(pinned("chain", "[]"), Points{});
  // 9 10 11
  // 6  7  8
  // 3  4  5
  // 0  1  2
  EXPECT_EQ(pinned("cloth", "'left_edge'"), (Points{0, 3, 6, 9}));
  EXPECT_EQ(pinned("cloth", "'right_edge'"), (Points{2, 5, 8, 11}));
  EXPECT_EQ(pinned("cloth", "'bottom_edge'"), (Points{0, 1, 2}));
  EXPECT_EQ(pinned("cloth", "'top_edge'"), (Points{9, 10, 11}));
  EXPECT_EQ(pinned("cloth", "'corners'"), (Points{0, 2, 9, 11}));
  EXPECT_EQ(pinned("cloth", "'top_corners'"), (Points{9, 11}));
  EXPECT_EQ(pinned("cloth", "'bottom_corners'"), (Points{0, 2}));
  EXPECT_EQ(pinned("cloth", "['top_left', 'bottom_right']"), (Points{2, 9}));
  EXPECT_EQ(pinned("cloth", "['top_right', 'bottom_left']"), (Points{0, 11}));
  EXPECT_EQ(pinned("cloth", "'boundary'"), (Points{0, 1, 2, 3, 5, 6, 8, 9, 10, 11}));
  for (const std::string kind : {"grid", "block"}) {
    EXPECT_EQ(pinned(kind, "'left_face'"), (Points{0, 3, 6, 9, 12, 15, 18, 21, 24}));
    EXPECT_EQ(pinned(kind, "'right_face'"), (Points{2, 5, 8, 11, 14, 17, 20, 23, 26}));
    EXPECT_EQ(pinned(kind, "'front_face'"), (Points{0, 1, 2, 9, 10, 11, 18, 19, 20}));
    EXPECT_EQ(pinned(kind, "'back_face'"), (Points{6, 7, 8, 15, 16, 17, 24, 25, 26}));
    EXPECT_EQ(pinned(kind, "'bottom_face'"), (Points{0, 1, 2, 3, 4, 5, 6, 7, 8}));
    EXPECT_EQ(pinned(kind, "'top_face'"), (Points{18, 19, 20, 21, 22, 23, 24, 25, 26}));
    EXPECT_EQ(pinned(kind, "'bottom_corners'"), (Points{0, 2, 6, 8}));
    EXPECT_EQ(pinned(kind, "'top_corners'"), (Points{18, 20, 24, 26}));
    EXPECT_EQ(pinned(kind, "'corners'"), (Points{0, 2, 6, 8, 18, 20, 24, 26}));
    EXPECT_EQ(pinned(kind, "'boundary'").size(), 26u);
  }
}

TEST(GeneratedScene, KeepsTheRecipeInItsResolvedText) {
  const Scene scene = parse_scene(
      "[generate]\nkind = 'grid'\ncounts = [3, 2, 4]\nspacing = 0.1\ntotal_mass = 0.7\nstiffness = 10\n"
      "velocity = [0.1, 0.2, 0.3]\npinned = ['left_face', 5]\n[[anchor]]\nparticle = ['right_face', "
      "1]\nstiffness = 2\n",
      "a.toml");
  EXPECT_EQ(
      scene.resolved_toml,
      "title = \"\"\n"
      "\n[[anchor]]\ndamping = 0.0\nparticle = [\"right_face\", 1]\nstiffness = 2\n"
      "\n[generate]\ncounts = [3, 2, 4]\ndamping = 0.0\nkind = \"grid\"\nlaw = \"hooke\"\n"
      "origin = [0.0, 0.0, 0.0]\npinned = [\"left_face\", 5]\nrest_length_factor = 1.0\nspacing = 0.1\n"
      "springs = [\"structural\", \"shear\"]\nstiffness = 10\ntotal_mass = 0.7\nvelocity = [0.1, 0.2, 0.3]\n"
      "\n[world]\ndrag = 0.0\ngravity = [0.0, 0.0, 0.0]\n");
  expect_same_scene(scene, parse_scene(scene.resolved_toml, "b.toml"));
  EXPECT_EQ(scene.model.anchors.size(), 9u);
}

TEST(GeneratedScene, MayHaveNoSpringsAtAll) {
  const Scene scene = parse_scene(
      "[generate]\nkind = 'grid'\ncounts = [2, 2, 2]\nspacing = 1\nmass = 1\nsprings = []\n", "a.toml");
  EXPECT_EQ(scene.model.springs.size(), 0u);
  EXPECT_EQ(scene.model.mass.size(), 8u);
}

}  // namespace
}  // namespace fw::scene
