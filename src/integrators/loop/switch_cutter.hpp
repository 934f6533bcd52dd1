#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "core/state_archive.hpp"
#include "ode/switching_surfaces.hpp"

namespace fw::integrators {

/// Decides where steps that a method chooses have to end because of kinks and jumps of the right-hand side
/// (decision 0067). An error estimate is made for smooth f: it does not see a wall that no stage has met.
///
/// A step whose path (see `StatePath`) switches at the time s is taken back and ends just before the switch,
/// where all its stages are on one side. A step of the width w follows that crosses the surface, with
///
///   jump·w + rate·w²/2 ≤ tolerance/100,   tolerance = absolute + relative·speed   [m/s],
///
/// so that what the kink spoils of it does not matter, and from there the method starts anew, with a first
/// step of at most 1/10 of 1/ω. A path that was wrong about s is so by O(s²): few repetitions close in.
///
/// What cannot matter is not cut: a switch with jump·τ + rate·τ²/2 ≤ tolerance/10, τ the time from it to the
/// end of the step. A net of a thousand ropes switches in every step all the same. A kink that the step resolves
/// (ω h ≤ 1, jump·h ≤ speed, and the new phase lasts to the end of the step) is one that the stages see, and the
/// error estimate with them: it is cut while such kinks are few, 20 and one more for every fifty steps, so that a
/// run costs little more than without. Where a switch that does not matter yet would matter in a step as long as
/// this one, and ω h > 1, the method starts anew as after a cut: the stages of a long step can all miss a force
/// that is stiff enough to throw them out of the solid.
template <class Scalar>
class SwitchCutter final : public SwitchSink<Scalar> {
 public:
  /// `absolute` [m/s] and `relative` tolerance of velocities; `smallest_width` w is never below [s]: above the
  /// rounding of t by orders of magnitude.
  /// `everywhere`: also the resolved ones, however many.
  SwitchCutter(double absolute, double relative, Scalar smallest_width, bool everywhere = false)
      : absolute_(absolute), relative_(relative), smallest_width_(smallest_width), everywhere_(everywhere) {}

  void set_absolute_tolerance(double absolute) { absolute_ = absolute; }

  enum class Verdict {
    accepted,  ///< nothing switches
    crossed,   ///< something does, and the step is as short as it should be: the method starts anew after it
    again,     ///< the step is to be tried again from its start, up to `limit()`
    chatters,  ///< switches follow each other without end
  };

  /// On a step that has passed its error test.
  Verdict judge(const SwitchingSurfaces& surfaces, const StatePath<Scalar>& path) {
    length_ = path.length;
    is_found_ = false;
    frequency_at_end_ = 0.0;
    surfaces.find(path, *this);
    const Scalar end = path.start + path.length;
    if (!is_found_ && frequency_at_end_ > 0.0) {
      start_anew(end, frequency_at_end_);
      return Verdict::crossed;
    }
    if (!is_found_) {
      go_on(end);
      return Verdict::accepted;
    }
    const Scalar width = width_of(first_);
    if (phase_ == Phase::crossing || path.length <= width) {
      keep_patience(end, width);
      start_anew(end, first_.frequency);
      return is_out_of_patience_ ? Verdict::chatters : Verdict::crossed;
    }
    if (phase_ == Phase::free && cuts_ == 0 && is_resolved(first_)) --allowance_;
    // A path that keeps promising more than the step then finds leads further and further back.
    const Scalar margin =
        width / 4 * Scalar(std::exp2(2.0 * static_cast<double>(std::min<std::uint64_t>(cuts_++, 100))));
    if (first_.offset <= width / 2 || first_.offset - margin <= width / 2) {
      phase_ = Phase::crossing;
      limit_ = path.start + width;
    } else {
      phase_ = Phase::landing;
      width_ = width;
      limit_ = path.start + (first_.offset - margin);
    }
    return Verdict::again;
  }

  /// The step to come ends here at the latest [s].
  const Scalar& limit() const { return limit_; }
  /// The switch that was judged last.
  const Switch<Scalar>& last() const { return first_; }
  /// How many have been crossed.
  std::uint64_t crossed() const { return crossed_; }

  void add(const Switch<Scalar>& found) override {
    if (is_found_ && found.offset >= first_.offset) return;
    const auto matters_in = [&](double time) {
      return found.jump * time + 0.5 * found.rate * time * time > 0.1 * tolerance(found);
    };
    const auto length = static_cast<double>(length_);
    if (phase_ != Phase::crossing && !matters_in(static_cast<double>(length_ - found.offset))) {
      if (found.to == found.at_end && found.frequency * length > 1.0 && matters_in(length)) {
        frequency_at_end_ = std::max(frequency_at_end_, found.frequency);
      }
      return;
    }
    if (phase_ != Phase::crossing && is_resolved(found) && allowance_ <= 0.0) return;
    first_ = found;
    is_found_ = true;
  }

  void serialise(StateArchive& archive) requires(std::is_same_v<Scalar, double>) {
    auto phase = static_cast<std::uint64_t>(phase_);
    archive.visit("way across a switch", phase);
    phase_ = static_cast<Phase>(phase);
    archive.visit("end of the step at a switch", limit_);
    archive.visit("width of a switch", width_);
    archive.visit("cuts of the step", cuts_);
    archive.visit("switches", crossed_);
    archive.visit("resolved kinks to cut", allowance_);
    archive.visit("time of an earlier switch", window_start_);
    archive.visit("widths of the switches since then", widths_);
  }

 private:
  enum class Phase {
    free,      ///< steps as the method likes
    landing,   ///< towards the last time before a switch
    crossing,  ///< across it
    starting,  ///< the first step after it
  };

  static constexpr double most_resolved = 20.0;
  static Scalar unlimited() { return std::numeric_limits<Scalar>::infinity(); }

  /// After a switch, into a force of this frequency.
  void start_anew(const Scalar& end, double frequency) {
    phase_ = frequency > 0.0 ? Phase::starting : Phase::free;
    limit_ = frequency > 0.0 ? Scalar(end + Scalar(0.1 / frequency)) : unlimited();
    cuts_ = 0;
  }

  /// By a step of the present length.
  bool is_resolved(const Switch<Scalar>& found) const {
    const auto length = static_cast<double>(length_);
    // rate = ω²·speed, of whichever side of the surface the force is on; a spring has two ends that move.
    return !everywhere_ && found.to == found.at_end && found.rate * length * length <= 2.0 * found.speed &&
           found.jump * length <= found.speed;
  }

  void go_on(const Scalar& end) {
    cuts_ = 0;
    allowance_ = std::min(allowance_ + 0.02, most_resolved);
    const bool is_there = end >= limit_;
    if (phase_ == Phase::landing && is_there) {
      phase_ = Phase::crossing;
      limit_ = end + width_;
    } else if (phase_ == Phase::starting || is_there) {
      phase_ = Phase::free;
      limit_ = unlimited();
    }
  }

  double tolerance(const Switch<Scalar>& found) const { return absolute_ + relative_ * found.speed; }

  Scalar width_of(const Switch<Scalar>& found) const {
    const double allowed = 0.01 * tolerance(found);
    // The positive root of rate·w²/2 + jump·w = allowed, without cancellation.
    const double root = std::sqrt(found.jump * found.jump + 2.0 * found.rate * allowed);
    const double width = root + found.jump > 0.0 ? 2.0 * allowed / (found.jump + root) : 0.0;
    return std::max(smallest_width_, Scalar(width));
  }

  /// So many switches within hardly more than their own widths are no physics.
  void keep_patience(const Scalar& end, const Scalar& width) {
    constexpr std::uint64_t window = 1000;
    widths_ += width;
    if (crossed_++ % window != 0) return;
    is_out_of_patience_ = crossed_ > window && end - window_start_ <= 4 * widths_;
    window_start_ = end;
    widths_ = 0;
  }

  double absolute_, relative_;
  Scalar smallest_width_;
  bool everywhere_;
  double allowance_ = most_resolved;  ///< how many resolved kinks may be cut
  Scalar length_{}, limit_ = unlimited(), width_{}, window_start_{}, widths_{};
  Phase phase_ = Phase::free;
  std::uint64_t cuts_ = 0;         ///< of the present step
  double frequency_at_end_ = 0.0;  ///< of stiff forces that begin where it does not matter for the step yet
  bool is_found_ = false, is_out_of_patience_ = false;
  std::uint64_t crossed_ = 0;
  Switch<Scalar> first_{};
};

/// The width that a surface is crossed with at least where t is between t0 and t1 [s].
inline double smallest_switch_width(double t0, double t1) {
  return 1e4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(t0), std::abs(t1));
}

}  // namespace fw::integrators
