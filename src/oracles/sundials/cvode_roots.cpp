#include "oracles/sundials/cvode_roots.hpp"

#include <cvodes/cvodes.h>
#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
#include "oracles/sundials/cvode_session.hpp"

namespace fw::oracles {

namespace {

using namespace detail;

int direction_of(EventDirection direction) {
  switch (direction) {
    case EventDirection::rising:
      return 1;
    case EventDirection::falling:
      return -1;
    case EventDirection::both:
      break;
  }
  return 0;
}

/// The event functions of a run and what was found of them.
class RootFinder {
 public:
  explicit RootFinder(const std::vector<EventFunction>& functions) : functions_(functions) {
    for (std::size_t k = 0; k < functions_.size(); ++k) {
      if (!functions_[k].value) {
        throw InputError(fmt::format("events: function {} (\"{}\") is empty", k, functions_[k].name));
      }
    }
  }

  std::vector<Event>& events() { return events_; }
  /// The event that ends the run, or null.
  const Event* terminal_event() const { return terminated_ ? &events_.back() : nullptr; }
  const std::string& name_of(const Event& event) const { return functions_[event.function].name; }

  void attach(void* memory) const {
    if (functions_.empty()) return;
    std::vector<int> directions;
    for (const EventFunction& function : functions_) directions.push_back(direction_of(function.direction));
    require(CVodeRootInit(memory, static_cast<int>(functions_.size()), evaluate), "CVodeRootInit");
    require(CVodeSetRootDirection(memory, directions.data()), "CVodeSetRootDirection");
    require(CVodeSetNoInactiveRootWarn(memory), "CVodeSetNoInactiveRootWarn");
  }

  void values(double t, ConstVectorRef y, double* g) const {
    for (std::size_t k = 0; k < functions_.size(); ++k) {
      g[k] = functions_[k].value(t, y);
      if (!std::isfinite(g[k])) {
        throw InputError(
            fmt::format("event function {} (\"{}\"): found {} at t = {:.6g}, expected a finite number", k,
                        functions_[k].name, g[k], t));
      }
    }
  }

  /// Keeps the events that CVODE has stopped at, up to the first terminal one.
  void record(void* memory, double t, ConstVectorRef y) {
    std::vector<int> found(functions_.size());
    require(CVodeGetRootInfo(memory, found.data()), "CVodeGetRootInfo");
    for (std::size_t k = 0; k < functions_.size() && !terminated_; ++k) {
      if (found[k] == 0) continue;
      events_.push_back({t, y, k});
      terminated_ = functions_[k].terminal;
    }
  }

 private:
  /// CVODE's callback; the user data are the session's, which leads back here.
  static int evaluate(sunrealtype t, N_Vector y, sunrealtype* g, void* user_data);

  const std::vector<EventFunction>& functions_;
  std::vector<Event> events_;
  bool terminated_ = false;
};

/// A session that knows its root finder.
class SessionWithRoots final : public CvodeSession {
 public:
  SessionWithRoots(RootFinder& finder, CvodeFormula formula, const CvodeOptions& options, const Ivp& ivp,
                   const AdaptiveStep& tolerances, Work& work)
      : CvodeSession(formula, options, ivp, tolerances, work), roots(finder) {
    roots.attach(memory());
  }

  RootFinder& roots;
};

int RootFinder::evaluate(sunrealtype t, N_Vector y, sunrealtype* g, void* user_data) {
  auto& session = static_cast<SessionWithRoots&>(*static_cast<CvodeSession*>(user_data));
  return session.guard().call([&] {
    session.roots.values(t, view(y, session.system().size()), g);
    return 0;
  });
}

/// Passes roots over to the finder, so that the loop sees whole steps, until a terminal event.
class RootStepper final : public ForeignStepper {
 public:
  RootStepper(RootFinder& finder, Observer& observer, CvodeFormula formula, const CvodeOptions& options,
              const Ivp& ivp, const StepControl& control, Work& work)
      : observer_(observer), session_(finder, formula, options, ivp, std::get<AdaptiveStep>(control), work) {}

  Status advance(double limit, double& t, VectorRef y) override {
    ++steps_;
    CvodeEvent event = CvodeEvent::root;
    while (event == CvodeEvent::root) {
      if (Status status = session_.advance(limit, t, y, &event); !status.ok()) return status;
      if (event != CvodeEvent::root) break;
      session_.roots.record(session_.memory(), t, y);
      if (const Event* end = session_.roots.terminal_event()) return stop_at(*end);
    }
    return {};
  }
  void interpolate(double t, VectorRef out) override { session_.interpolate(t, out); }
  void restart(double t, ConstVectorRef y) override { session_.restart(t, y); }
  void collect_work(Work& work) const override { session_.collect_work(work); }

 private:
  Status stop_at(const Event& event) {
    const std::function<void(double, VectorRef)> dense = [this](double t, VectorRef out) {
      interpolate(t, out);
    };
    observer_.observe({steps_, event.time, event.state, false, dense});
    return {StatusCode::stopped_by_observer,
            fmt::format("event \"{}\" at t = {:.6g}", session_.roots.name_of(event), event.time)};
  }

  Observer& observer_;
  SessionWithRoots session_;
  std::uint64_t steps_ = 0;
};

}  // namespace

SolutionWithEvents solve_with_cvode_roots(CvodeFormula formula, const CvodeOptions& options, const Ivp& ivp,
                                          const AdaptiveStep& tolerances,
                                          const std::vector<EventFunction>& functions, Observer& observer) {
  RootFinder finder(functions);
  const OracleIntegrator integrator(
      cvode_info(formula, options),
      [&](const Ivp& problem, const StepControl& control, Work& work) {
        return std::make_unique<RootStepper>(finder, observer, formula, options, problem, control, work);
      },
      ToleranceScaling{.factor = options.tolerance_factor});
  Solution solution = integrator.solve(ivp, tolerances, observer);
  if (const Event* event = finder.terminal_event()) {
    solution.time = event->time;
    solution.state = event->state;
  }
  return {std::move(solution), std::move(finder.events())};
}

}  // namespace fw::oracles
