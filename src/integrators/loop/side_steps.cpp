#include "integrators/loop/side_steps.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace fw::integrators {

namespace {

constexpr int most_parts = 256;

/// θ_k of `count` places: zeros of a Chebyshev polynomial, stretched to [0, 1].
std::vector<double> chebyshev_places(int count) {
  std::vector<double> places;
  const double last = std::cos(std::numbers::pi / (2.0 * count));
  for (int k = 0; k < count; ++k) {
    places.push_back(0.5 - 0.5 * std::cos((2.0 * k + 1.0) * std::numbers::pi / (2.0 * count)) / last);
  }
  places.front() = 0.0;
  places.back() = 1.0;
  return places;
}

}  // namespace

SideStep side_step_of(std::function<std::unique_ptr<Stepper>()> make) {
  const auto stepper = std::make_shared<std::unique_ptr<Stepper>>();
  return [stepper, make = std::move(make)](double t, double t_end, ConstVectorRef y, VectorRef out) {
    if (!*stepper) *stepper = make();
    (*stepper)->restart(t, y);
    out = y;
    return (*stepper)->step(t, t_end - t, out);
  };
}

SideSteps::SideSteps(const OdeSystem& system, int nodes, SideStep step, Work& work,
                     ContinuousExtension* extension)
    : system_(system), step_(std::move(step)), work_(work), extension_(extension) {
  // The polynomial of slopes has the degree of that with one node.
  if (nodes != 1 || (extension_ != nullptr && !extension_->has_continuous_weights())) extension_ = nullptr;
  if (nodes == 0) return;
  if (extension_ != nullptr) {
    const auto& places = SlopePolynomial::places();
    places_.assign(places.begin(), places.end());
  } else {
    places_ = chebyshev_places(nodes + 2);
  }
}

void SideSteps::set_step(double t, double t_end, ConstVectorRef start, ConstVectorRef end) {
  start_time_ = t;
  end_time_ = t_end;
  start_ = start.data();
  end_ = end.data();
  is_prepared_ = false;
}

void SideSteps::operator()(double t, VectorRef out) {
  if (t == start_time_ || t == end_time_) {
    out = ConstVectorMap(t == start_time_ ? start_ : end_, out.size());
    return;
  }
  if (!places_.empty()) {
    if (!is_prepared_) prepare();
    if (has_polynomial_) {
      evaluate((t - start_time_) / (end_time_ - start_time_), out);
      return;
    }
  }
  reach(t, out);
}

bool SideSteps::reach(double t, VectorRef out) {
  for (int parts = 1; parts <= most_parts; parts *= 2) {
    if (reach_in_parts(t, parts, out)) return true;
  }
  out.setConstant(std::numeric_limits<double>::quiet_NaN());
  return false;
}

bool SideSteps::reach_in_parts(double t, int parts, VectorRef out) {
  double from_time = start_time_;
  for (int part = 1; part <= parts; ++part) {
    const double to =
        part == parts ? t : start_time_ + (t - start_time_) * (static_cast<double>(part) / parts);
    if (part == 1) {
      from_ = ConstVectorMap(start_, out.size());
    } else {
      from_ = out;
    }
    if (to > from_time && !(step_(from_time, to, from_, out).ok() && out.allFinite())) return false;
    from_time = to;
  }
  return true;
}

void SideSteps::prepare() {
  is_prepared_ = true;
  states_.resize(places_.size());
  slopes_.resize(places_.size());
  for (Vector& state : states_) state.resize(system_.size());
  for (Vector& slope : slopes_) slope.resize(system_.size());
  states_.front() = ConstVectorMap(start_, system_.size());
  states_.back() = ConstVectorMap(end_, system_.size());
  has_polynomial_ = true;
  for (std::size_t i = 0; i < places_.size() && has_polynomial_; ++i) {
    const bool is_end = i == 0 || i + 1 == places_.size();
    const double time =
        i + 1 == places_.size() ? end_time_ : start_time_ + places_[i] * (end_time_ - start_time_);
    if (!is_end && extension_ != nullptr) {
      extension_->extend(places_[i], end_time_ - start_time_, states_.front(), states_[i]);
    } else if (!is_end) {
      has_polynomial_ = reach(time, states_[i]);
    }
    if (!has_polynomial_) return;
    system_.rhs(time, states_[i], slopes_[i]);
    ++work_.rhs_evaluations;
    has_polynomial_ = slopes_[i].allFinite();
  }
}

void SideSteps::evaluate(double theta, VectorRef out) const {
  const double h = end_time_ - start_time_;
  out = states_.front();
  // In differences: a component that rests at all places rests in between, to the last bit.
  if (extension_ != nullptr) {
    const SlopePolynomial::Weights weights = SlopePolynomial::weights(theta);
    out += weights.end * (states_.back() - states_.front());
    for (std::size_t i = 0; i < places_.size(); ++i) out += (h * weights.slopes[i]) * slopes_[i];
    return;
  }
  // Hermite's fundamental polynomials: (1 − 2 l_i'(θ_i)(θ − θ_i)) l_i(θ)² and (θ − θ_i) l_i(θ)².
  for (std::size_t i = 0; i < places_.size(); ++i) {
    double value = 1.0, slope = 0.0;  // of Lagrange's polynomial l_i: l_i(θ), l_i'(θ_i)
    for (std::size_t j = 0; j < places_.size(); ++j) {
      if (j == i) continue;
      value *= (theta - places_[j]) / (places_[i] - places_[j]);
      slope += 1.0 / (places_[i] - places_[j]);
    }
    const double distance = theta - places_[i];
    if (i > 0) out += ((1.0 - 2.0 * slope * distance) * value * value) * (states_[i] - states_.front());
    out += (h * distance * value * value) * slopes_[i];
  }
}

int side_step_nodes(const MethodInfo& info) {
  if (info.dense_output != DenseOutput::side_step_polynomial) return 0;
  int nodes = 1;
  while (2 * nodes + 3 < info.order) ++nodes;
  return nodes;
}

}  // namespace fw::integrators
