#include "mechanics/assembly/element_assembly.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "extended_list.hpp"
#include "plain_twin.hpp"
#include "random_model.hpp"

namespace fw::mechanics {
namespace {

template <class S>
double magnitude(const S& value) {
  using std::abs;
  return static_cast<double>(abs(value));
}

/// The largest deviation of the elements' forces and energies from the twin's, over the twin's largest force
/// and its energies, in the arithmetic S.
template <class S>
double deviation_from_twin(const MassSpringModel& assembled, const MassSpringModel& model, const State& state,
                           S imaginary_unit) {
  std::vector<S> q, v;
  for (Index c = 0; c < state.q.size(); ++c) {
    q.push_back(S(state.q[c]) + imaginary_unit * S(0.01 * static_cast<double>(c % 5)));
    v.push_back(S(state.v[c]) - imaginary_unit * S(0.02 * static_cast<double>(c % 3)));
  }
  std::vector<S> f(q.size());
  assemble<ElementBatch>(assembled)->force(q.data(), v.data(), f.data());
  const PlainTwin<S> twin(model, q, v);
  double largest = 0.0, deviation = 0.0;
  for (int i = 0; i < twin.count(); ++i) {
    const Vec3<S> expected = twin.force(i), found = load3(f.data(), i);
    for (const S& component : {expected.x, expected.y, expected.z}) {
      largest = std::max(largest, magnitude(component));
    }
    for (const S& wrong : {found.x - expected.x, found.y - expected.y, found.z - expected.z}) {
      deviation = std::max(deviation, magnitude(wrong));
    }
  }
  deviation /= largest;
  S elastic(0), gravitational(0), obstacle(0);
  for (const ElementBatch& batch : elements_of<ElementBatch>(assembled)) {
    std::visit(
        [&]<class Elements>(const Elements& elements) {
          S& sum = Elements::labels.energy == "elastic"    ? elastic
                   : Elements::labels.energy == "obstacle" ? obstacle
                                                           : gravitational;
          add_energy(elements, q.data(), sum);
        },
        batch);
  }
  const double scale = magnitude(twin.elastic_energy()) + magnitude(twin.gravitational_energy()) +
                       magnitude(twin.obstacle_energy());
  for (const S& wrong : {elastic - twin.elastic_energy(), gravitational - twin.gravitational_energy(),
                         obstacle - twin.obstacle_energy()}) {
    deviation = std::max(deviation, magnitude(wrong) / scale);
  }
  return deviation;
}

TEST(ElementAssembly, AgreesWithItsSlowTwinInEveryArithmetic) {
  RandomModels random(20261128);
  for (const SpringLaw law : all_laws) {
    for (int trial = 0; trial < 40; ++trial) {
      const MassSpringModel model = trial % 2 == 0 ? random.everything(law) : random.everything_in_groups();
      const State state = random.state(model);
      EXPECT_LE(deviation_from_twin<double>(model, model, state, 0.0), 1e-13);
      EXPECT_LE(deviation_from_twin<Complex>(model, model, state, Complex(0.0, 1.0)), 1e-13);
      EXPECT_LE(deviation_from_twin<Float128>(model, model, state, Float128(0)), 1e-31);
    }
  }
}

TEST(ElementAssembly, IsToldFromItsTwinByOneGroupUnderAnotherLaw) {
  RandomModels random(20261129);
  const MassSpringModel model = random.everything_in_groups();
  const State state = random.state(model);
  MassSpringModel wrong = model;
  wrong.springs.groups[1].law = SpringLaw::hooke;
  EXPECT_GE(deviation_from_twin<double>(wrong, model, state, 0.0), 1e-3);
  wrong = model;
  ++wrong.springs.groups[0].size;  // the border between two groups is off by one
  --wrong.springs.groups[1].size;
  EXPECT_GE(deviation_from_twin<double>(wrong, model, state, 0.0), 1e-4);
}

TEST(ElementAssembly, OfOneGroupIsThatOfTheLawToTheLastBit) {
  RandomModels random(20261130);
  for (const SpringLaw law : all_laws) {
    const MassSpringModel model = random.everything(law);
    MassSpringModel grouped = model;
    grouped.springs.law = SpringLaw::hooke;
    grouped.springs.groups = {{"a", law, 9}, {"b", law, 7}};
    const State state = random.state(model);
    const MassSpringSystem one(model), two(grouped);
    EXPECT_EQ(force_of(one, state), force_of(two, state));
    EXPECT_EQ(dense_stiffness(one, state), dense_stiffness(two, state));
    EXPECT_EQ(dense_damping(one, state), dense_damping(two, state));
    EXPECT_EQ(one.energies(state.q, state.v).total(), two.energies(state.q, state.v).total());
    EXPECT_EQ(one.dissipated_power(state.q, state.v), two.dissipated_power(state.q, state.v));
  }
}

TEST(ElementAssembly, OfGroupsHasExactTangents) {
  RandomModels random(20261131);
  for (int trial = 0; trial < 20; ++trial) {
    const MassSpringModel model = random.everything_in_groups();
    const State state = random.state(model);
    const MassSpringSystem system(model);
    const auto [K, D] = complex_step_tangents(model, state);
    EXPECT_LE(relative_deviation(dense_stiffness(system, state), K), 1e-13);
    EXPECT_LE(relative_deviation(dense_damping(system, state), D), 1e-13);
  }
}

TEST(ElementAssembly, RefusesGroupsThatDoNotCoverTheSprings) {
  RandomModels random(20261132);
  MassSpringModel model = random.everything_in_groups();
  model.springs.groups.back().size -= 1;
  EXPECT_THROW(MassSpringSystem{model}, InputError);
  model.springs.groups.back().size += 2;
  EXPECT_THROW(MassSpringSystem{model}, InputError);
}

TEST(FurtherElements, OfTheModelAreSummedAfterTheOthers) {
  RandomModels random(20261133);
  MassSpringModel model = random.network(SpringLaw::hooke, 6, 8, true);
  const State state = random.state(model);
  static const std::vector<Anchor> anchors = {{2, {0.1, 0.2, 0.3}, 5.0, 0.5}};
  MassSpringModel anchored = model;
  anchored.anchors = anchors;
  model.further_elements = {AnchorBatch{anchors}};
  EXPECT_EQ(force_of(MassSpringSystem(model), state), force_of(MassSpringSystem(anchored), state));
}

/// Four particles, two triangles and a tetrahedron beside springs, one corner fixed.
struct Membrane {
  MassSpringModel model;
  std::vector<TestBatch> further;
  State state;

  explicit Membrane(std::uint64_t seed, double damping = 0.7) {
    RandomModels random(seed);
    model = random.network(SpringLaw::hooke, 5, 4, damping > 0.0);
    model.gravity = random.point(10.0);
    model.fixed = {3};
    further = {TriangleAreaBatch{{{{0, 1, 2}, 0.4, 30.0, damping}, {{2, 1, 3}, 0.9, 50.0, 0.0}}},
               TetrahedronVolumeBatch{{{{4, 1, 0, 2}, 0.2, 40.0}}}};
    state = random.state(model);
  }
};

/// ∂V/∂q by complex steps, of the elements of one kind.
template <class Elements>
Vector energy_gradient(const Elements& elements, const Vector& q) {
  std::vector<Complex> place(q.begin(), q.end());
  Vector gradient(q.size());
  for (Index c = 0; c < q.size(); ++c) {
    const auto k = static_cast<std::size_t>(c);
    place[k].imag(1e-200);
    Complex sum(0.0);
    add_energy(elements, place.data(), sum);
    place[k].imag(0.0);
    gradient[c] = sum.imag() / 1e-200;
  }
  return gradient;
}

TEST(ElementsOfThreeAndFourNodes, HaveForcesThatAreTheGradientOfTheirEnergy) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Membrane membrane(20261140 + seed, 0.0);
    const Vector& q = membrane.state.q;
    for (const TestBatch& batch : membrane.further) {
      std::visit(
          [&](const auto& elements) {
            Vector force = Vector::Zero(q.size());
            const Vector rest = Vector::Zero(q.size());
            add_force(elements, q.data(), rest.data(), force.data());
            EXPECT_LE(relative_deviation(-energy_gradient(elements, q), force), 1e-13);
          },
          batch);
    }
  }
}

TEST(ElementsOfThreeAndFourNodes, AreAssembledIntoExactMatricesAndProducts) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Membrane membrane(20261160 + seed);
    const MassSpringSystem system(membrane.model, with_elements(membrane.further));
    const State& state = membrane.state;
    auto [K, D] = complex_step_tangents(system.elements(), state);
    EXPECT_LE(relative_deviation(dense_stiffness(system, state), K), 1e-12);
    EXPECT_LE(relative_deviation(dense_damping(system, state), D), 1e-13);

    const Index n = state.q.size();
    const Vector w = RandomModels(seed).vector(2 * n, 1.0);
    Vector product(n);
    system.tangent_product(0.0, state.q, state.v, w.head(n), w.tail(n), product);
    EXPECT_LE(relative_deviation(product, K * w.head(n) + D * w.tail(n)), 1e-12);

    SparseMatrix J = system.jacobian_pattern();
    system.jacobian(0.0, state.stacked(), J);
    Vector slope(2 * n);
    system.jacobian_product(0.0, state.stacked(), w, slope);
    EXPECT_LE(relative_deviation(J * w, slope), 1e-12);
  }
}

TEST(ElementsOfThreeAndFourNodes, HaveOneBlockPerPairOfNeighboursAndNoOther) {
  const Membrane membrane(20261190);
  const MassSpringSystem system(membrane.model, with_elements(membrane.further));
  Matrix expected = Matrix::Identity(5, 5);
  const auto join = [&](std::initializer_list<int> nodes) {
    for (const int a : nodes) {
      for (const int b : nodes) expected(a, b) = 1.0;
    }
  };
  join({0, 1, 2});
  join({2, 1, 3});
  join({4, 1, 0, 2});
  for (std::size_t e = 0; e < membrane.model.springs.size(); ++e) {
    join({membrane.model.springs.first[e], membrane.model.springs.second[e]});
  }
  SparseMatrix pattern = system.tangent_pattern();
  pattern.coeffs().setOnes();
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j)
      EXPECT_EQ(Matrix(pattern)(3 * i, 3 * j + 2), expected(i, j)) << i << ", " << j;
  }
}

TEST(ElementsOfThreeAndFourNodes, AddEnergiesOfTheirOwnNamesAndLoseWhatTheirDampersTake) {
  const Membrane membrane(20261191);
  const State& state = membrane.state;
  const MassSpringSystem system(membrane.model, with_elements(membrane.further));
  const Energies energies = system.energies(state.q, state.v);
  ASSERT_EQ(energies.list().size(), 6u);
  EXPECT_EQ(energies.list()[4].name, "area");
  EXPECT_EQ(energies.list()[5].name, "volume");
  EXPECT_EQ(energies.list()[5].unit, "J");
  EXPECT_GT(energies["area"], 0.0);
  EXPECT_GT(energies["volume"], 0.0);
  EXPECT_DOUBLE_EQ(energies.potential(),
                   energies["elastic"] + energies["gravitational"] + energies["area"] + energies["volume"]);
  // dE/dt = F·v + ∇V·v = −power, where no particle is held.
  MassSpringModel free = membrane.model;
  free.fixed.clear();
  const MassSpringSystem loose(free, with_elements(membrane.further));
  double slope = force_of(loose, state).dot(state.v);
  const auto add_slope = [&](const auto& elements) {
    slope += energy_gradient(elements, state.q).dot(state.v);
  };
  for (const ElementBatch& batch : elements_of<ElementBatch>(free)) std::visit(add_slope, batch);
  for (const TestBatch& batch : membrane.further) std::visit(add_slope, batch);
  const double power = loose.dissipated_power(state.q, state.v);
  EXPECT_GT(power, 0.1);
  EXPECT_NEAR(slope, -power, 1e-12 * power);
}

TEST(ElementsOfThreeAndFourNodes, OfNoAreaAreCountedAndExertNothing) {
  Membrane membrane(20261192);
  membrane.state.q.segment<3>(6) =
      membrane.state.q.segment<3>(3);  // corners 1 and 2 of both triangles coincide
  membrane.model.springs = {};
  membrane.further.pop_back();
  membrane.model.gravity = {};
  const MassSpringSystem system(membrane.model, with_elements(membrane.further));
  EXPECT_EQ(force_of(system, membrane.state).norm(), 0.0);
  EXPECT_EQ(system.degenerate_spring_evaluations(), 2u);
}

TEST(ElementsOfThreeAndFourNodes, ThatAreWrongAreRefusedByTheirOwnCheck) {
  Membrane membrane(20261193);
  std::get<TriangleAreaBatch>(membrane.further[0]).triangles[1].particles[2] = 5;
  try {
    const MassSpringSystem system(membrane.model, with_elements(membrane.further));
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "triangles[1].particles: found 5, expected a particle index from 0 to 4");
  }
}

}  // namespace
}  // namespace fw::mechanics
