#include "mechanics/driving.hpp"

#include <algorithm>
#include <limits>

#include "mechanics/elements/element_validation.hpp"
#include "mechanics/mass_spring_model.hpp"

namespace fw::mechanics {

namespace {

template <class Scalar, class Value>
Vec3<Scalar> vector_as(const Vec3<Value>& a) {
  return {Scalar(a.x), Scalar(a.y), Scalar(a.z)};
}

/// x − p − d(t) [m].
Vec3<double> offset_of(const Anchor& anchor, const Vec3<double>& displacement, const double* q) {
  return anchor_offset(anchor, load3(q, anchor.particle)) - displacement;
}

}  // namespace

bool Driving::is_needed(const MassSpringModel& model) {
  return !model.forces.empty() || !model.support_motions.empty();
}

Driving::Driving(const MassSpringModel& model) : particles_(model.mass.size()) {
  std::vector<char> is_fixed(particles_, 0);
  for (const int i : model.fixed) is_fixed[static_cast<std::size_t>(i)] = 1;
  for (std::size_t k = 0; k < model.forces.size(); ++k) {
    Acting& acting = forces_.emplace_back(Acting{model.forces[k].force, {}});
    for (const int i : model.forces[k].particles) {
      require_particle("forces", k, ".particles", i, particles_);
      if (is_fixed[static_cast<std::size_t>(i)] == 0) acting.particles.push_back(i);
    }
  }
  for (std::size_t k = 0; k < model.support_motions.size(); ++k) {
    Support& support = supports_.emplace_back(Support{model.support_motions[k].displacement, {}, {}});
    for (const int a : model.support_motions[k].anchors) {
      if (a < 0 || static_cast<std::size_t>(a) >= model.anchors.size()) {
        refuse("support_motions", k, ".anchors", a,
               fmt::format("the index of one of {} anchors", model.anchors.size()));
      }
      const Anchor& anchor = model.anchors[static_cast<std::size_t>(a)];
      require_particle("anchors", static_cast<std::size_t>(a), ".particle", anchor.particle, particles_);
      support.anchors.push_back(anchor);
      support.is_free.push_back(is_fixed[static_cast<std::size_t>(anchor.particle)] == 0 ? 1 : 0);
    }
  }
  const auto add = [&](Corner corner) {
    if (!corner.function->corners().empty() && !corner.particles.empty())
      corners_.push_back(std::move(corner));
  };
  for (std::size_t k = 0; k < forces_.size(); ++k) {
    Corner corner{
        .kind = "forces", .number = k, .function = &forces_[k].force, .particles = forces_[k].particles};
    for (const int i : corner.particles) {
      corner.rate = std::max(corner.rate, 1.0 / model.mass[static_cast<std::size_t>(i)]);
    }
    add(std::move(corner));
  }
  for (std::size_t k = 0; k < supports_.size(); ++k) {
    Corner corner{.kind = "supports", .number = k, .function = &supports_[k].displacement};
    for (std::size_t a = 0; a < supports_[k].anchors.size(); ++a) {
      if (supports_[k].is_free[a] == 0) continue;
      const Anchor& anchor = supports_[k].anchors[a];
      const double mass = model.mass[static_cast<std::size_t>(anchor.particle)];
      corner.jump = std::max(corner.jump, anchor.damping / mass);
      corner.rate = std::max(corner.rate, anchor.stiffness / mass);
      corner.particles.push_back(anchor.particle);
    }
    add(std::move(corner));
  }
}

template <class Time, class Scalar>
void Driving::add_force_as(const Time& t, Scalar* f) const {
  for (const Acting& acting : forces_) {
    if (acting.particles.empty()) continue;
    const Vec3<Scalar> force = vector_as<Scalar>(acting.force(t).value);
    for (const int i : acting.particles) add3(f, i, force);
  }
  for (const Support& support : supports_) {
    const auto path = support.displacement(t);
    for (std::size_t a = 0; a < support.anchors.size(); ++a) {
      if (support.is_free[a] == 0) continue;
      const Anchor& anchor = support.anchors[a];
      const auto force = Time(anchor.stiffness) * path.value + Time(anchor.damping) * path.rate;
      add3(f, anchor.particle, vector_as<Scalar>(force));
    }
  }
}

double Driving::energy_of_motion(double t, const double* q) const {
  double energy = 0.0;
  for (const Support& support : supports_) {
    const Vec3<double> d = support.displacement(t).value;
    for (const Anchor& anchor : support.anchors) {
      const Vec3<double> standing = anchor_offset(anchor, load3(q, anchor.particle)), moved = standing - d;
      energy += 0.5 * anchor.stiffness * (dot(moved, moved) - dot(standing, standing));
    }
  }
  return energy;
}

double Driving::dissipation_of_motion(double t, const double* v) const {
  double power = 0.0;
  for (const Support& support : supports_) {
    const Vec3<double> rate = support.displacement(t).rate;
    for (const Anchor& anchor : support.anchors) {
      const Vec3<double> velocity = load3(v, anchor.particle), relative = velocity - rate;
      power += anchor.damping * (dot(relative, relative) - dot(velocity, velocity));
    }
  }
  return power;
}

double Driving::external_power(double t, const double* q, const double* v) const {
  double power = 0.0;
  for (const Acting& acting : forces_) {
    if (acting.particles.empty()) continue;
    const Vec3<double> force = acting.force(t).value;
    for (const int i : acting.particles) power += dot(force, load3(v, i));
  }
  for (const Support& support : supports_) {
    const auto path = support.displacement(t);
    for (const Anchor& anchor : support.anchors) {
      const Vec3<double> relative = load3(v, anchor.particle) - path.rate;
      power -=
          dot(anchor.stiffness * offset_of(anchor, path.value, q) + anchor.damping * relative, path.rate);
    }
  }
  return power;
}

bool Driving::is_smooth() const {
  return std::ranges::all_of(forces_, [](const Acting& acting) { return acting.force.is_smooth(); }) &&
         std::ranges::all_of(supports_,
                             [](const Support& support) { return support.displacement.is_smooth(); });
}

bool Driving::has_corners() const {
  return !corners_.empty();
}

template <class Scalar>
void Driving::find_corners(const StatePath<Scalar>& path, SwitchSink<Scalar>& sink) const {
  const Scalar end = path.start + path.length;
  const auto modulus = [](const Scalar& a) { return a < 0 ? Scalar(-a) : a; };
  const Scalar rounding =
      Scalar(8) * std::numeric_limits<Scalar>::epsilon() * std::max(modulus(path.start), modulus(end));
  const auto is_before = [](const Scalar& time, double corner) { return time < Scalar(corner); };
  for (const Corner& corner : corners_) {
    const std::vector<double>& times = corner.function->corners();
    const auto first = std::upper_bound(times.begin(), times.end(), Scalar(path.start + rounding), is_before);
    if (first == times.end() || Scalar(*first) > end) continue;
    const auto k = static_cast<std::size_t>(first - times.begin());
    const auto after_end = std::upper_bound(first, times.end(), end, is_before);
    Switch<Scalar> found{.offset = Scalar(*first) - path.start,
                         .from = static_cast<int>(k) + 1,
                         .to = static_cast<int>(k) + 2,
                         .at_end = static_cast<int>(after_end - times.begin()) + 1,
                         .kind = corner.kind,
                         .number = corner.number,
                         .nodes = {corner.particles.front(), -1}};
    const double change = norm(corner.function->slope_change(k));
    found.jump = corner.jump * change;
    found.rate = corner.rate * change;
    for (const int i : corner.particles) {
      for (const Scalar* y : {path.from, path.to}) {
        const auto speed = static_cast<double>(norm(load3(y + 3 * particles_, i)));
        found.speed = std::max(found.speed, speed);
      }
    }
    sink.add(found);
  }
}

template void Driving::find_corners(const StatePath<double>&, SwitchSink<double>&) const;
template void Driving::find_corners(const StatePath<Float128>&, SwitchSink<Float128>&) const;
template void Driving::add_force_as(const double&, double*) const;
template void Driving::add_force_as(const double&, Complex*) const;
template void Driving::add_force_as(const Float128&, Float128*) const;

}  // namespace fw::mechanics
