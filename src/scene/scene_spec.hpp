#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mechanics/elements/spring_law.hpp"
#include "settings/archive.hpp"

namespace fw::scene {

/// [world] rayleigh
struct RayleighSpec {
  double mass = 0.0;       ///< α [1/s]
  double stiffness = 0.0;  ///< β [s]
};
void declare(settings::Archive& a, RayleighSpec& rayleigh);

/// [world]
struct WorldSpec {
  Vec3<double> gravity{};  ///< [m/s²]
  double drag = 0.0;       ///< [kg/s]
  std::optional<RayleighSpec> rayleigh;
};
void declare(settings::Archive& a, WorldSpec& world);

/// [particles]
struct ParticlesSpec {
  std::vector<Vec3<double>> position;                 ///< [m]
  std::optional<std::vector<Vec3<double>>> velocity;  ///< [m/s]
  std::vector<double> mass;                           ///< [kg], one or one per particle
  std::vector<int> fixed;
};
void declare(settings::Archive& a, ParticlesSpec& particles);

/// [springs]
struct SpringsSpec {
  std::size_t particles = 0;  ///< that there are
  IndexPairs between;
  std::vector<double> stiffness;        ///< [N/m]; [N] with the law strain; one or one per spring
  std::vector<double> damping = {0.0};  ///< [N·s/m], one or one per spring
  mechanics::SpringLaw law = mechanics::SpringLaw::hooke;
  std::optional<std::vector<double>> rest_length;  ///< [m], one or one per spring
};
void declare(settings::Archive& a, SpringsSpec& springs);

/// One of the sections [[springs]]: a group with a law of its own.
struct SpringGroupSpec {
  SpringsSpec springs;
  std::string name;
};
void declare(settings::Archive& a, SpringGroupSpec& group);

/// [generate]
struct GenerateSpec {
  std::string kind;
  std::int64_t count = 0;            ///< of a chain
  std::vector<std::int64_t> counts;  ///< of the others, along each axis
  std::optional<double> length;      ///< of a chain [m]
  std::optional<std::vector<double>> size;
  std::optional<double> spacing;
  Vec3<double> origin{};
  Vec3<double> direction{1.0, 0.0, 0.0};
  std::string plane = "xy";
  std::optional<std::vector<double>> mass;  ///< [kg], one or one per particle
  std::optional<double> total_mass, density;
  std::optional<std::vector<std::string>> springs;  ///< families; has a value once it has been read
  std::optional<NumberTable> stiffness,
      damping;  ///< by family, "" for all; have a value if there are families
  mechanics::SpringLaw law = mechanics::SpringLaw::hooke;
  double rest_length_factor = 1.0;
  PointList pinned;
  Vec3<double> velocity{};
};
void declare(settings::Archive& a, GenerateSpec& generate);

/// The number of points of the lattice that `generate` describes.
std::size_t particle_count(const GenerateSpec& generate);

/// `table` of a function of time
struct TimeTableSpec {
  std::vector<double> t;            ///< [s]
  std::vector<Vec3<double>> value;  ///< as many
};
void declare(settings::Archive& a, TimeTableSpec& table);

/// A vector as a function of time, in one of these forms.
struct TimeFunctionSpec {
  std::optional<Vec3<double>> vector;  ///< a constant value, or a constant velocity
  std::optional<TimeTableSpec> table;
  std::optional<std::vector<std::string>> expression;  ///< three, of t
};

/// [[force]]
struct ForceSpec {
  std::size_t particles = 0;             ///< that there are
  std::vector<std::string> point_names;  ///< that groups of them have
  PointList particle;
  TimeFunctionSpec force;  ///< [N]
};
void declare(settings::Archive& a, ForceSpec& force);

/// [[anchor]]
struct AnchorSpec {
  std::size_t particles = 0;             ///< that there are
  std::vector<std::string> point_names;  ///< that groups of them have
  PointList particle;
  double stiffness = 0.0, damping = 0.0;
  std::optional<Vec3<double>> position;
  TimeFunctionSpec displacement;  ///< [m]
};
void declare(settings::Archive& a, AnchorSpec& anchor);

/// [[obstacle]]
struct ObstacleSpec {
  std::string shape;
  Vec3<double> point{}, normal{}, centre{}, lower{}, upper{};
  double radius = 0.0, stiffness = 0.0, damping = 0.0;
};
void declare(settings::Archive& a, ObstacleSpec& obstacle);

/// A scene file.
struct SceneSpec {
  std::string title;
  std::optional<std::string> start;
  WorldSpec world;
  std::optional<GenerateSpec> generate;
  std::optional<ParticlesSpec> particles;
  std::optional<SpringsSpec> springs;
  std::vector<SpringGroupSpec> spring_groups;  ///< in place of `springs`
  std::vector<AnchorSpec> anchors;
  std::vector<ForceSpec> forces;
  std::vector<ObstacleSpec> obstacles;
};
void declare(settings::Archive& a, SceneSpec& scene);

}  // namespace fw::scene
