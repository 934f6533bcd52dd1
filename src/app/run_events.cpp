#include "app/run_events.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/error.hpp"

namespace fw::app {

namespace {

using Kind = EventRequest::Kind;

struct Form {
  Kind kind;
  std::string_view name, form;
};
constexpr Form forms[] = {{Kind::contact, "contact", "contact[:PARTICLE]"},
                          {Kind::release, "release", "release[:PARTICLE]"},
                          {Kind::taut, "taut", "taut[:SPRING]"},
                          {Kind::slack, "slack", "slack[:SPRING]"},
                          {Kind::plane, "plane", "plane:NX,NY,NZ,D[:PARTICLE]"},
                          {Kind::energy, "energy", "energy:NAME"}};

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts(1);
  for (const char letter : text) {
    if (letter == at) {
      parts.emplace_back();
    } else {
      parts.back() += letter;
    }
  }
  return parts;
}

[[noreturn]] void refuse(const std::string& option, const std::string& text, const std::string& why) {
  std::string all;
  for (const Form& form : forms) all += fmt::format("{}{}", all.empty() ? "" : ", ", form.form);
  throw InputError(fmt::format("{}: found \"{}\", {}; the forms are {}", option, text, why, all));
}

template <class Number>
std::optional<Number> number_in(const std::string& text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

/// "kinetic", "potential" or a name of the list.
bool is_energy(const Energies& energies, const std::string& name) {
  return name == "potential" ||
         std::ranges::any_of(energies.list(), [&](const auto& e) { return e.name == name; });
}

double energy_of(const Energies& energies, const std::string& name) {
  return name == "potential" ? energies.potential() : energies[name];
}

/// dE/dt along the motion: f·v of the kinetic energy, a central difference along the velocity of the others.
double power(const mechanics::MassSpringSystem& system, const std::string& name, double t, ConstVectorRef y) {
  const Index n = system.degrees_of_freedom();
  const auto q = y.head(n), v = y.tail(n);
  if (name == "kinetic") {
    Vector force(n);
    system.force(t, q, v, force);
    return force.dot(v);
  }
  const double speed = v.lpNorm<Eigen::Infinity>();
  if (speed == 0.0) return 0.0;
  const double size = std::max(q.lpNorm<Eigen::Infinity>(), 1e-3);
  const double delta = std::cbrt(std::numeric_limits<double>::epsilon()) * size / speed;
  const Vector later = q + delta * v, earlier = q - delta * v;
  const double after = energy_of(system.energies(t + delta, later, v), name);  // supports move along
  return (after - energy_of(system.energies(t - delta, earlier, v), name)) / (2.0 * delta);
}

std::vector<EventFunction> functions_of(const std::vector<EventRequest>& requests,
                                        const mechanics::MassSpringSystem& system) {
  std::vector<EventFunction> list;
  for (const EventRequest& request : requests) {
    if (request.kind == Kind::energy) {
      list.push_back({.name = request.text,
                      .value = [&system, name = request.energy](
                                   double t, ConstVectorRef y) { return power(system, name, t, y); },
                      .terminal = request.stops});
    }
    if (request.kind != Kind::plane) continue;
    const int first = request.index.value_or(0);
    const int end = request.index ? first + 1 : static_cast<int>(system.particle_count());
    for (int i = first; i < end; ++i) {
      list.push_back({.name = fmt::format("{}: particle {}", request.text, i),
                      .value = [n = request.normal, d = request.offset, i](
                                   double, ConstVectorRef y) { return dot(n, load3(y.data(), i)) - d; },
                      .terminal = request.stops});
    }
  }
  return list;
}

EventRequest parse_event(const std::string& option, const std::string& text,
                         const mechanics::MassSpringSystem& system) {
  std::vector<std::string> parts = split(text, ':');
  const auto* form = std::ranges::find(forms, std::string_view(parts[0]), &Form::name);
  if (form == std::end(forms)) refuse(option, text, "expected an event");
  EventRequest request{.text = text, .kind = form->kind};
  std::size_t next = 1;
  if (request.kind == Kind::plane) {
    const auto numbers = parts.size() > 1 ? split(parts[1], ',') : std::vector<std::string>{};
    double values[4] = {};
    if (numbers.size() != 4) refuse(option, text, "expected four numbers NX,NY,NZ,D after \"plane:\"");
    for (std::size_t k = 0; k < 4; ++k) {
      const auto value = number_in<double>(numbers[k]);
      if (!value || !std::isfinite(*value))
        refuse(option, text, fmt::format("expected a number for \"{}\"", numbers[k]));
      values[k] = *value;
    }
    request.normal = {values[0], values[1], values[2]};
    request.offset = values[3];
    if (norm(request.normal) == 0.0) refuse(option, text, "expected a normal that is not zero");
    next = 2;
  } else if (request.kind == Kind::energy) {
    request.energy = parts.size() > 1 ? parts[1] : "";
    const Vector rest = Vector::Zero(system.degrees_of_freedom());
    const Energies known = system.energies(rest, rest);
    if (!is_energy(known, request.energy)) {
      std::string names = "potential";
      for (const NamedValue& energy : known.list()) names += fmt::format(", {}", energy.name);
      refuse(option, text, fmt::format("expected the name of an energy: {}", names));
    }
    next = 2;
  }
  if (parts.size() > next) {
    const bool is_spring = request.kind == Kind::taut || request.kind == Kind::slack;
    const auto count = is_spring ? static_cast<int>(system.model().springs.size())
                                 : static_cast<int>(system.particle_count());
    request.index = number_in<int>(parts[next]);
    if (request.kind == Kind::energy || parts.size() > next + 1 || !request.index || *request.index < 0 ||
        *request.index >= count) {
      refuse(option, text,
             fmt::format("expected the number of a {} from 0 to {} at the end",
                         is_spring ? "spring" : "particle", count - 1));
    }
  }
  const bool needs_switches = request.kind != Kind::plane && request.kind != Kind::energy;
  if (needs_switches && system.switching_surfaces() == nullptr) {
    throw InputError(fmt::format(
        "{}: found \"{}\", but the scene has no obstacle and no rope (law \"tension_only\")", option, text));
  }
  return request;
}

}  // namespace

std::vector<EventRequest> parse_events(const std::vector<std::string>& log_at,
                                       const std::vector<std::string>& stop_at,
                                       const mechanics::MassSpringSystem& system) {
  std::vector<EventRequest> requests;
  for (const std::string& text : log_at) requests.push_back(parse_event("--log-at", text, system));
  for (const std::string& text : stop_at) {
    requests.push_back(parse_event("--stop-at", text, system));
    requests.back().stops = true;
  }
  return requests;
}

/// The requests that the system's surfaces tell of.
class RunEvents::Switches final : public SwitchSink<double> {
 public:
  Switches(std::vector<EventRequest> requests, Observer& inner)
      : requests_(std::move(requests)), inner_(inner) {}

  bool observe(const mechanics::MassSpringSystem& system, const StepView& view) {
    if (view.index > 0 && view.time > time_) {
      const SwitchingSurfaces* surfaces = system.switching_surfaces();
      found_.clear();
      if (surfaces != nullptr)
        surfaces->find({time_, view.time - time_, state_.data(), view.state.data()}, *this);
      std::ranges::stable_sort(found_, {}, &MetEvent::time);
      for (const MetEvent& event : found_) {
        events_.push_back(event);
        if (event.stops) return stop(view, event.time);
      }
    }
    time_ = view.time;
    state_ = view.state;
    return inner_.observe(view);
  }

  void add(const Switch<double>& found) override {
    for (const EventRequest& request : requests_) {
      const bool is_solid = found.thickness > 0.0;
      const bool begins = found.from == 0, ends = found.to == 0;
      const int index = is_solid ? found.nodes[0] : static_cast<int>(found.number);
      const bool fits = request.kind == Kind::contact   ? is_solid && begins
                        : request.kind == Kind::release ? is_solid && ends
                        : request.kind == Kind::taut    ? !is_solid && begins
                                                        : !is_solid && ends;
      if (!fits || (request.index && *request.index != index)) continue;
      found_.push_back(
          {time_ + found.offset, fmt::format("{}: {}", request.text, place_of(found)), request.stops});
    }
  }

  const std::vector<MetEvent>& events() const { return events_; }
  bool has_stopped() const { return has_stopped_; }
  double time() const { return time_; }
  const Vector& state() const { return state_; }

 private:
  bool stop(const StepView& view, double time) {
    Vector state = view.state;
    if (time < view.time && view.interpolate) view.interpolate(time, state);
    inner_.observe({view.index, time, state, false, view.interpolate});
    has_stopped_ = true;
    time_ = time;
    state_ = state;
    return false;
  }

  std::vector<EventRequest> requests_;
  Observer& inner_;
  std::vector<MetEvent> events_, found_;
  double time_ = 0.0;  ///< of the last state, or of the event that stops
  Vector state_;
  bool has_stopped_ = false;
};

RunEvents::RunEvents(std::vector<EventRequest> requests, const mechanics::MassSpringSystem& system,
                     Observer& inner)
    : system_(system) {
  auto functions = functions_of(requests, system);
  std::erase_if(requests, [](const auto& r) { return r.kind == Kind::plane || r.kind == Kind::energy; });
  locator_ = std::make_unique<EventLocator>(std::move(functions), inner, EventOptions{.samples_per_step = 2});
  switches_ = std::make_unique<Switches>(std::move(requests), *locator_);
}

RunEvents::~RunEvents() = default;

bool RunEvents::observe(const StepView& view) {
  return switches_->observe(system_, view);
}

std::vector<MetEvent> RunEvents::events() const {
  std::vector<MetEvent> all = switches_->events();
  for (const Event& event : locator_->events()) {
    const EventFunction& function = locator_->functions()[event.function];
    all.push_back({event.time, function.name, function.terminal});
  }
  std::ranges::stable_sort(all, {}, &MetEvent::time);
  return all;
}

std::optional<std::string> RunEvents::stop(Solution& solution) const {
  if (const Event* event = locator_->terminal_event()) {
    solution.time = event->time;
    solution.state = event->state;
    return locator_->functions()[event->function].name;
  }
  if (!switches_->has_stopped()) return {};
  solution.time = switches_->time();
  solution.state = switches_->state();
  return switches_->events().back().what;
}

}  // namespace fw::app
