#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scene/scene.hpp"

namespace fw::scene {

/// Expects that two functions of time have the same values and corners.
inline void expect_same_function(const formula::VectorFunction& a, const formula::VectorFunction& b) {
  for (const double t : {0.0, 0.3, 1.7, 40.0}) {
    EXPECT_EQ(a(t).value, b(t).value);
    EXPECT_EQ(a(t).rate, b(t).rate);
  }
  EXPECT_EQ(a.corners(), b.corners());
}

/// Expects that two scenes are equal bit for bit in everything that a solver sees.
inline void expect_same_scene(const Scene& a, const Scene& b) {
  EXPECT_EQ(a.title, b.title);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.model.mass, b.model.mass);
  EXPECT_EQ(a.model.fixed, b.model.fixed);
  EXPECT_EQ(a.model.gravity, b.model.gravity);
  EXPECT_EQ(a.model.drag, b.model.drag);
  EXPECT_EQ(a.model.mass_drag, b.model.mass_drag);
  ASSERT_EQ(a.model.forces.size(), b.model.forces.size());
  for (std::size_t k = 0; k < a.model.forces.size(); ++k) {
    EXPECT_EQ(a.model.forces[k].particles, b.model.forces[k].particles);
    expect_same_function(a.model.forces[k].force, b.model.forces[k].force);
  }
  ASSERT_EQ(a.model.support_motions.size(), b.model.support_motions.size());
  for (std::size_t k = 0; k < a.model.support_motions.size(); ++k) {
    EXPECT_EQ(a.model.support_motions[k].anchors, b.model.support_motions[k].anchors);
    expect_same_function(a.model.support_motions[k].displacement, b.model.support_motions[k].displacement);
  }
  EXPECT_EQ(a.model.springs.first, b.model.springs.first);
  EXPECT_EQ(a.model.springs.second, b.model.springs.second);
  EXPECT_EQ(a.model.springs.stiffness, b.model.springs.stiffness);
  EXPECT_EQ(a.model.springs.damping, b.model.springs.damping);
  EXPECT_EQ(a.model.springs.rest_length, b.model.springs.rest_length);
  EXPECT_EQ(a.model.springs.law, b.model.springs.law);
  ASSERT_EQ(a.model.springs.groups.size(), b.model.springs.groups.size());
  for (std::size_t k = 0; k < a.model.springs.groups.size(); ++k) {
    EXPECT_EQ(a.model.springs.groups[k].name, b.model.springs.groups[k].name);
    EXPECT_EQ(a.model.springs.groups[k].law, b.model.springs.groups[k].law);
    EXPECT_EQ(a.model.springs.groups[k].size, b.model.springs.groups[k].size);
  }
  ASSERT_EQ(a.model.anchors.size(), b.model.anchors.size());
  for (std::size_t i = 0; i < a.model.anchors.size(); ++i) {
    EXPECT_EQ(a.model.anchors[i].particle, b.model.anchors[i].particle);
    EXPECT_EQ(a.model.anchors[i].rest_position, b.model.anchors[i].rest_position);
    EXPECT_EQ(a.model.anchors[i].stiffness, b.model.anchors[i].stiffness);
    EXPECT_EQ(a.model.anchors[i].damping, b.model.anchors[i].damping);
  }
  ASSERT_EQ(a.model.obstacles.size(), b.model.obstacles.size());
  for (std::size_t i = 0; i < a.model.obstacles.size(); ++i) {
    const auto& p = a.model.obstacles[i];
    const auto& q = b.model.obstacles[i];
    EXPECT_EQ(p.stiffness, q.stiffness);
    EXPECT_EQ(p.damping, q.damping);
    ASSERT_EQ(p.shape.index(), q.shape.index());
    if (const auto* plane = std::get_if<mechanics::Plane>(&p.shape)) {
      EXPECT_EQ(plane->point, std::get<mechanics::Plane>(q.shape).point);
      EXPECT_EQ(plane->normal, std::get<mechanics::Plane>(q.shape).normal);
    } else if (const auto* sphere = std::get_if<mechanics::Sphere>(&p.shape)) {
      EXPECT_EQ(sphere->centre, std::get<mechanics::Sphere>(q.shape).centre);
      EXPECT_EQ(sphere->radius, std::get<mechanics::Sphere>(q.shape).radius);
    } else {
      EXPECT_EQ(std::get<mechanics::Box>(p.shape).lower, std::get<mechanics::Box>(q.shape).lower);
      EXPECT_EQ(std::get<mechanics::Box>(p.shape).upper, std::get<mechanics::Box>(q.shape).upper);
    }
  }
}

}  // namespace fw::scene
