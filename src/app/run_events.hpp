#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/mass_spring_system.hpp"
#include "ode/event_locator.hpp"
#include "ode/switching_surfaces.hpp"

namespace fw::app {

/// An event that --log-at or --stop-at names:
///   contact[:P]  release[:P]   an obstacle begins or ends to press on particle P, or on any
///   taut[:S]  slack[:S]        rope S, or any
///   plane:NX,NY,NZ,D[:P]       particle P, or any, passes n·x = D
///   energy:NAME                an extremum of the energy of that name, or of `potential`
struct EventRequest {
  enum class Kind { contact, release, taut, slack, plane, energy };
  std::string text;  ///< as it was given
  Kind kind = Kind::contact;
  std::optional<int> index{};  ///< of the particle or the spring; none: any
  Vec3<double> normal{};       ///< of the plane
  double offset = 0.0;         ///< D
  std::string energy{};
  bool stops = false;  ///< ends the run
};

/// Reads those of --log-at and --stop-at. Throws InputError that names the option and shows the forms, or the
/// index that is out of range.
std::vector<EventRequest> parse_events(const std::vector<std::string>& log_at,
                                       const std::vector<std::string>& stop_at,
                                       const mechanics::MassSpringSystem& system);

/// An event that was met.
struct MetEvent {
  double time = 0.0;  ///< [s]
  std::string what;   ///< the request and where: "contact: obstacles[0] and particle 3"
  bool stops = false;
};

/// Finds the events of a run and passes its steps on. Contacts and ropes are looked for on the whole path of each
/// step (`SwitchingSurfaces`), so that none is between two states; planes and energies where their sign changes
/// between the ends of a step or its middle, located by dense output.
class RunEvents final : public Observer {
 public:
  RunEvents(std::vector<EventRequest> requests, const mechanics::MassSpringSystem& system, Observer& inner);
  ~RunEvents() override;

  bool observe(const StepView& view) override;

  /// In the order of time.
  std::vector<MetEvent> events() const;
  /// Puts time and state of a run that an event has stopped to that event; its text, or none.
  std::optional<std::string> stop(Solution& solution) const;

 private:
  class Switches;

  const mechanics::MassSpringSystem& system_;
  std::unique_ptr<EventLocator> locator_;
  std::unique_ptr<Switches> switches_;
};

}  // namespace fw::app
