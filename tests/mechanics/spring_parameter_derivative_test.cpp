#include "mechanics/spring_parameter_derivative.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "mechanics/model_elements.hpp"

namespace fw::mechanics {
namespace {

constexpr SpringParameter all_parameters[] = {SpringParameter::stiffness, SpringParameter::damping,
                                              SpringParameter::rest_length};

/// Four particles in a ring with a chord, one of them fixed; the last spring is shorter than its rest length,
/// so that a rope is slack there.
struct Ring {
  MassSpringModel model;
  Vector q{{0.0, 0.1, 0.0, 1.1, 0.0, 0.2, 1.0, 0.9, -0.1, 0.1, 1.2, 0.3}};
  Vector v{{0.0, 0.0, 0.0, 0.3, -0.2, 0.4, -0.5, 0.1, 0.2, 0.7, 0.6, -0.3}};

  explicit Ring(SpringLaw law) {
    model.mass = {1.0, 2.0, 0.5, 1.5};
    model.fixed = {0};
    model.springs = {{0, 1, 2, 3, 0},           {1, 2, 3, 0, 2},           {10.0, 20.0, 15.0, 30.0, 12.0},
                     {0.3, 0.1, 0.4, 0.5, 0.2}, {0.9, 0.8, 0.7, 1.0, 2.5}, law};
    model.gravity = {0.0, 0.0, -9.81};
  }
};

std::vector<double>& numbers(Springs& springs, SpringParameter parameter) {
  if (parameter == SpringParameter::stiffness) return springs.stiffness;
  return parameter == SpringParameter::damping ? springs.damping : springs.rest_length;
}

Vector force(const MassSpringModel& model, ConstVectorRef q, ConstVectorRef v) {
  Vector f(q.size());
  assemble<ElementBatch>(model)->force(q.data(), v.data(), f.data());
  return f;
}

/// Central differences with Richardson's extrapolation.
Vector difference(const Ring& ring, const SpringParameterGroup& group) {
  const auto central = [&](double h) {
    MassSpringModel up = ring.model, down = ring.model;
    const auto shift = [&](int e) {
      numbers(up.springs, group.parameter)[static_cast<std::size_t>(e)] += h;
      numbers(down.springs, group.parameter)[static_cast<std::size_t>(e)] -= h;
    };
    if (group.springs.empty()) {
      for (int e = 0; e < static_cast<int>(ring.model.springs.size()); ++e) shift(e);
    }
    for (const int e : group.springs) shift(e);
    return Vector((force(up, ring.q, ring.v) - force(down, ring.q, ring.v)) / (2.0 * h));
  };
  return (4.0 * central(1e-4) - central(2e-4)) / 3.0;
}

double disagreement(const Ring& ring, const SpringParameterGroup& group, ConstVectorRef derivative) {
  return (difference(ring, group) - derivative).lpNorm<Eigen::Infinity>();
}

TEST(SpringParameterDerivative, AgreesWithDifferencesOfTheForce) {
  for (const SpringLaw law : {SpringLaw::hooke, SpringLaw::strain, SpringLaw::tension_only}) {
    const Ring ring(law);
    for (const SpringParameter parameter : all_parameters) {
      for (const std::vector<int>& springs : {std::vector<int>{}, {0}, {1}, {2, 3}, {4}}) {
        const SpringParameterGroup group{parameter, springs};
        Vector derivative = Vector::Constant(12, 99.0);
        parameter_derivative(ring.model, group, ring.q, ring.v, derivative);
        EXPECT_LT(disagreement(ring, group, derivative), 1e-9);
        EXPECT_EQ(derivative.head(3), Vector::Zero(3)) << "a fixed particle";
      }
    }
  }
}

TEST(SpringParameterDerivative, OfAllSpringsIsTheSumOverSingleOnes) {
  const Ring ring(SpringLaw::strain);
  for (const SpringParameter parameter : all_parameters) {
    Vector all(12), one(12), sum = Vector::Zero(12);
    parameter_derivative(ring.model, {parameter}, ring.q, ring.v, all);
    for (int e = 0; e < 5; ++e) {
      parameter_derivative(ring.model, {parameter, {e}}, ring.q, ring.v, one);
      sum += one;
    }
    EXPECT_LT((all - sum).lpNorm<Eigen::Infinity>(), 1e-13);
  }
}

TEST(SpringParameterDerivative, VanishesForASlackRopeAndAtLengthZero) {
  Ring ring(SpringLaw::tension_only);
  Vector derivative(12);
  for (const SpringParameter parameter : {SpringParameter::stiffness, SpringParameter::rest_length}) {
    parameter_derivative(ring.model, {parameter, {4}}, ring.q, ring.v, derivative);
    EXPECT_EQ(derivative, Vector::Zero(12));
  }
  Ring folded(SpringLaw::hooke);
  folded.q.segment<3>(3) = folded.q.segment<3>(6);
  for (const SpringParameter parameter : all_parameters) {
    parameter_derivative(folded.model, {parameter, {1}}, folded.q, folded.v, derivative);
    EXPECT_EQ(derivative, Vector::Zero(12));
  }
}

TEST(SpringParameterDerivative, ADerivativeWithoutItsFactorIsSeen) {
  // Negative control: −r in place of −k_s r.
  const Ring ring(SpringLaw::hooke);
  const SpringParameterGroup group{SpringParameter::rest_length, {2}};
  Vector derivative(12);
  parameter_derivative(ring.model, group, ring.q, ring.v, derivative);
  derivative /= ring.model.springs.stiffness[2];
  EXPECT_GT(disagreement(ring, group, derivative), 1.0);
}

TEST(SpringParameterDerivative, RefusesSpringsThatDoNotExist) {
  const Ring ring(SpringLaw::hooke);
  EXPECT_NO_THROW(validate({SpringParameter::stiffness, {0, 4}}, ring.model.springs));
  EXPECT_THROW(validate({SpringParameter::stiffness, {5}}, ring.model.springs), InputError);
  EXPECT_THROW(validate({SpringParameter::stiffness, {-1}}, ring.model.springs), InputError);
}

}  // namespace
}  // namespace fw::mechanics
