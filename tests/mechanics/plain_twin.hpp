#pragma once

#include <cmath>
#include <vector>

#include "mechanics/mass_spring_model.hpp"

namespace fw::mechanics {

/// Forces, potential energy and dissipated power of a mass-spring model, slow and obvious: written anew from
/// the laws [Zachmann 2011, S5-S9, S37], particle by particle, with a branch wherever there is a choice. It
/// shares with the program the description of the model and the arithmetic of `Vec3`, and no force law.
template <class S>
class PlainTwin {
 public:
  PlainTwin(const MassSpringModel& model, std::vector<S> q, std::vector<S> v)
      : model_(model), q_(std::move(q)), v_(std::move(v)) {}

  /// The force on particle i [N].
  Vec3<S> force(int i) const {
    for (const int k : model_.fixed) {
      if (k == i) return {};
    }
    Vec3<S> f =
        S(model_.mass[static_cast<std::size_t>(i)]) * wide(model_.gravity) - S(model_.drag) * velocity(i);
    for (std::size_t e = 0; e < model_.springs.size(); ++e) {
      const int first = model_.springs.first[e], second = model_.springs.second[e];
      if (first != i && second != i) continue;
      const int other = first == i ? second : first;
      const Vec3<S> towards = place(other) - place(i);
      const S length = norm(towards);
      const Vec3<S> r = (S(1) / length) * towards;
      const S closing = dot(velocity(other) - velocity(i), r);
      f += (tension(e, length) + S(model_.springs.damping[e]) * closing) * r;
    }
    for (const Anchor& anchor : model_.anchors) {
      if (anchor.particle != i) continue;
      f -= S(anchor.stiffness) * (place(i) - wide(anchor.rest_position)) + S(anchor.damping) * velocity(i);
    }
    for (const Obstacle& obstacle : model_.obstacles) {
      const auto [depth, normal] = penetration(obstacle, i);
      if (!(real_part(depth) > 0)) continue;
      const S pressing = S(obstacle.stiffness) * depth - S(obstacle.damping) * dot(velocity(i), normal);
      if (real_part(pressing) > 0) f += pressing * normal;
    }
    return f;
  }

  S elastic_energy() const {
    S energy(0);
    for (std::size_t e = 0; e < model_.springs.size(); ++e) {
      const S length = norm(place(model_.springs.second[e]) - place(model_.springs.first[e]));
      energy += S(0.5) * tension(e, length) * (length - S(model_.springs.rest_length[e]));
    }
    for (const Anchor& anchor : model_.anchors) {
      const Vec3<S> offset = place(anchor.particle) - wide(anchor.rest_position);
      energy += S(0.5) * S(anchor.stiffness) * dot(offset, offset);
    }
    return energy;
  }
  S gravitational_energy() const {
    S energy(0);
    for (int i = 0; i < count(); ++i) {
      energy -= S(model_.mass[static_cast<std::size_t>(i)]) * dot(wide(model_.gravity), place(i));
    }
    return energy;
  }
  S obstacle_energy() const {
    S energy(0);
    for (const Obstacle& obstacle : model_.obstacles) {
      for (int i = 0; i < count(); ++i) {
        const S depth = penetration(obstacle, i).depth;
        if (real_part(depth) > 0) energy += S(0.5) * S(obstacle.stiffness) * depth * depth;
      }
    }
    return energy;
  }

  int count() const { return static_cast<int>(model_.mass.size()); }

 private:
  struct Penetration {
    S depth;
    Vec3<S> normal;
  };

  static Vec3<S> wide(const Vec3<double>& a) { return {S(a.x), S(a.y), S(a.z)}; }
  Vec3<S> place(int i) const { return load3(q_.data(), i); }
  Vec3<S> velocity(int i) const { return load3(v_.data(), i); }

  SpringLaw law(std::size_t e) const {
    if (model_.springs.groups.empty()) return model_.springs.law;
    std::size_t k = 0, end = model_.springs.groups[0].size;
    while (e >= end) end += model_.springs.groups[++k].size;
    return model_.springs.groups[k].law;
  }
  S tension(std::size_t e, const S& length) const {
    const S k(model_.springs.stiffness[e]), l0(model_.springs.rest_length[e]);
    if (law(e) == SpringLaw::strain) return k * (length / l0 - S(1));
    if (law(e) == SpringLaw::tension_only && real_part(length) < model_.springs.rest_length[e]) return S(0);
    return k * (length - l0);
  }
  Penetration penetration(const Obstacle& obstacle, int i) const {
    const Vec3<S> x = place(i);
    if (const auto* plane = std::get_if<Plane>(&obstacle.shape)) {
      return {-dot(x - wide(plane->point), wide(plane->normal)), wide(plane->normal)};
    }
    if (const auto* ball = std::get_if<Sphere>(&obstacle.shape)) {
      const Vec3<S> offset = x - wide(ball->centre);
      const S distance = norm(offset);
      return {S(ball->radius) - distance, (S(1) / distance) * offset};
    }
    const Box& box = std::get<Box>(obstacle.shape);
    Penetration nearest{x.x - S(box.lower.x), {S(-1), S(0), S(0)}};
    const auto consider = [&](const S& depth, const Vec3<S>& normal) {
      if (real_part(depth) < real_part(nearest.depth)) nearest = {depth, normal};
    };
    consider(S(box.upper.x) - x.x, {S(1), S(0), S(0)});
    consider(x.y - S(box.lower.y), {S(0), S(-1), S(0)});
    consider(S(box.upper.y) - x.y, {S(0), S(1), S(0)});
    consider(x.z - S(box.lower.z), {S(0), S(0), S(-1)});
    consider(S(box.upper.z) - x.z, {S(0), S(0), S(1)});
    return nearest;
  }

  const MassSpringModel& model_;
  std::vector<S> q_, v_;
};

}  // namespace fw::mechanics
