#include "mechanics/model_validation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "core/error.hpp"
#include "mechanics/mass_spring_system.hpp"

namespace fw::mechanics {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

MassSpringModel valid_model() {
  MassSpringModel model;
  model.mass = {1.0, 2.0, 3.0};
  model.fixed = {0};
  model.springs = {{0, 1}, {1, 2}, {1.0, 2.0}, {0.0, 0.1}, {1.0, 0.0}, SpringLaw::hooke};
  model.anchors = {{1, {0.0, 0.0, 0.0}, 1.0, 0.0}};
  model.obstacles = {{Plane{{}, {0.0, 0.6, 0.8}}, 1.0, 0.0},
                     {Sphere{{}, 1.0}, 1.0, 0.0},
                     {Box{{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}}, 1.0, 0.0}};
  return model;
}

/// The message with which a changed model is refused.
template <class Change>
std::string refusal(Change change) {
  MassSpringModel model = valid_model();
  change(model);
  try {
    const MassSpringSystem system(model);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

using ::testing::HasSubstr;
using ::testing::StartsWith;
using Model = MassSpringModel;

TEST(ModelValidation, AcceptsAValidModelAndNeedsNoSprings) {
  EXPECT_EQ(refusal([](Model&) {}), "accepted");
  EXPECT_EQ(refusal([](Model& m) { m.springs = {}; }), "accepted");
}

TEST(ModelValidation, NamesTheArrayTheIndexAndWhatWasFound) {
  EXPECT_EQ(refusal([](Model& m) { m.springs.second[1] = 7; }),
            "springs.second[1]: found 7, expected a particle index from 0 to 2");
  EXPECT_EQ(refusal([](Model& m) { m.springs.stiffness[0] = -4.5; }),
            "springs.stiffness[0]: found -4.5, expected a finite number >= 0");
}

TEST(ModelValidation, RefusesWrongSizes) {
  EXPECT_THAT(refusal([](Model& m) { m.mass.clear(); }), StartsWith("mass: found 0"));
  EXPECT_THAT(refusal([](Model& m) { m.springs.second.pop_back(); }), StartsWith("springs.second: found 1"));
  EXPECT_THAT(refusal([](Model& m) { m.springs.stiffness.pop_back(); }),
              StartsWith("springs.stiffness: found 1"));
  EXPECT_THAT(refusal([](Model& m) { m.springs.damping.push_back(0); }),
              StartsWith("springs.damping: found 3"));
  EXPECT_THAT(refusal([](Model& m) { m.springs.rest_length.clear(); }),
              StartsWith("springs.rest_length: found 0"));
}

TEST(ModelValidation, RefusesIndicesOutOfRange) {
  EXPECT_THAT(refusal([](Model& m) { m.springs.first[0] = -1; }), StartsWith("springs.first[0]: found -1"));
  EXPECT_THAT(refusal([](Model& m) { m.springs.second[0] = 0; }), StartsWith("springs.second[0]: found 0"));
  EXPECT_THAT(refusal([](Model& m) { m.fixed = {2, 3}; }), StartsWith("fixed[1]: found 3"));
  EXPECT_THAT(refusal([](Model& m) { m.anchors[0].particle = 9; }),
              StartsWith("anchors[0].particle: found 9"));
}

TEST(ModelValidation, RefusesBadNumbers) {
  for (const double bad : {-1.0, nan, infinity}) {
    EXPECT_THAT(refusal([&](Model& m) { m.mass[2] = bad; }), StartsWith("mass[2]"));
    EXPECT_THAT(refusal([&](Model& m) { m.springs.stiffness[1] = bad; }), StartsWith("springs.stiffness[1]"));
    EXPECT_THAT(refusal([&](Model& m) { m.springs.damping[1] = bad; }), StartsWith("springs.damping[1]"));
    EXPECT_THAT(refusal([&](Model& m) { m.springs.rest_length[1] = bad; }),
                StartsWith("springs.rest_length[1]"));
    EXPECT_THAT(refusal([&](Model& m) { m.drag = bad; }), StartsWith("drag: found"));
    EXPECT_THAT(refusal([&](Model& m) { m.anchors[0].stiffness = bad; }), StartsWith("anchors[0].stiffness"));
    EXPECT_THAT(refusal([&](Model& m) { m.anchors[0].damping = bad; }), StartsWith("anchors[0].damping"));
    EXPECT_THAT(refusal([&](Model& m) { m.obstacles[1].stiffness = bad; }),
                StartsWith("obstacles[1].stiffness"));
    EXPECT_THAT(refusal([&](Model& m) { m.obstacles[2].damping = bad; }), StartsWith("obstacles[2].damping"));
    EXPECT_THAT(refusal([&](Model& m) { std::get<Sphere>(m.obstacles[1].shape).radius = bad; }),
                StartsWith("obstacles[1].radius"));
  }
  EXPECT_THAT(refusal([](Model& m) { m.mass[0] = 0.0; }), StartsWith("mass[0]: found 0"));
  for (const double bad : {nan, infinity}) {
    EXPECT_THAT(refusal([&](Model& m) { m.gravity.y = bad; }), StartsWith("gravity: found (0, "));
    EXPECT_THAT(refusal([&](Model& m) { m.anchors[0].rest_position.z = bad; }),
                StartsWith("anchors[0].rest_position"));
    EXPECT_THAT(refusal([&](Model& m) { std::get<Plane>(m.obstacles[0].shape).point.x = bad; }),
                StartsWith("obstacles[0].point"));
    EXPECT_THAT(refusal([&](Model& m) { std::get<Sphere>(m.obstacles[1].shape).centre.x = bad; }),
                StartsWith("obstacles[1].centre"));
    EXPECT_THAT(refusal([&](Model& m) { std::get<Box>(m.obstacles[2].shape).upper.x = bad; }),
                StartsWith("obstacles[2].upper"));
  }
}

TEST(ModelValidation, RefusesARestLengthOfZeroUnderStrainOnly) {
  EXPECT_EQ(refusal([](Model& m) { m.springs.law = SpringLaw::tension_only; }), "accepted");
  EXPECT_THAT(refusal([](Model& m) { m.springs.law = SpringLaw::strain; }),
              StartsWith("springs.rest_length[1]: found 0"));
  EXPECT_THAT(refusal([](Model& m) { m.springs.law = static_cast<SpringLaw>(17); }),
              HasSubstr("springs.law"));
}

TEST(ModelValidation, RefusesShapesThatAreNone) {
  const auto with_normal = [](Vec3<double> normal) {
    return refusal([&](Model& m) { std::get<Plane>(m.obstacles[0].shape).normal = normal; });
  };
  EXPECT_THAT(with_normal({}), StartsWith("obstacles[0].normal: found (0, 0, 0), expected a unit vector"));
  EXPECT_THAT(with_normal({0.0, 0.0, 2.0}), StartsWith("obstacles[0].normal"));
  EXPECT_THAT(with_normal({nan, 0.0, 1.0}), StartsWith("obstacles[0].normal"));
  const double third = 1.0 / std::sqrt(3.0);
  EXPECT_EQ(with_normal({third, third, third}), "accepted");
  EXPECT_THAT(refusal([](Model& m) { std::get<Sphere>(m.obstacles[1].shape).radius = 0.0; }),
              StartsWith("obstacles[1].radius: found 0"));
  EXPECT_THAT(refusal([](Model& m) { std::get<Box>(m.obstacles[2].shape).upper.y = 0.0; }),
              StartsWith("obstacles[2].upper"));
}

}  // namespace
}  // namespace fw::mechanics
