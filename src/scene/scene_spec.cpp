#include "scene/scene_spec.hpp"

#include <algorithm>

#include "scene/point_groups.hpp"

namespace fw::scene {

using mechanics::SpringLaw;
using settings::Archive;
using settings::choice;
using settings::setting;
using settings::Setting;

namespace {

constexpr std::int64_t largest_count = 2147483647;

settings::Setting law_setting(SpringLaw& law) {
  return choice("law", law,
                {{"hooke", SpringLaw::hooke},
                 {"strain", SpringLaw::strain},
                 {"tension_only", SpringLaw::tension_only}});
}

/// Rest lengths or their factor: > 0 with the law strain, which divides by them.
settings::Setting& with_range(const Archive& a, SpringLaw law, settings::Setting& rest_length) {
  return law == SpringLaw::strain && !a.is_description() ? rest_length.positive() : rest_length.nonnegative();
}

std::vector<std::string> names_of(const std::vector<PointGroup>& groups) {
  std::vector<std::string> names;
  for (const PointGroup& group : groups) names.push_back(group.name);
  return names;
}

/// The names of groups of points that any kind of scene has.
std::vector<std::string> all_point_names() {
  std::vector<std::string> names;
  const Lattice lattice;
  for (const auto& groups : {line_groups(lattice), sheet_groups(lattice), box_groups(lattice)}) {
    for (const PointGroup& group : groups) {
      if (std::find(names.begin(), names.end(), group.name) == names.end()) names.push_back(group.name);
    }
  }
  return names;
}

/// The names of groups of points in a scene with this kind of [generate], or in one with [particles].
std::vector<std::string> point_names(const std::string& kind) {
  return names_of(groups_of(kind, Lattice{}));
}

template <class Spec>
Setting particle_setting(const Archive& a, Spec& spec) {
  return setting("particle", spec.particle)
      .required()
      .choices(a.is_description() ? all_point_names() : spec.point_names)
      .into("particle", spec.particles)
      .doc("names as for `pinned`; a scene with `[particles]` has the name `all` only");
}

void declare_table(Archive& a, TimeFunctionSpec& function, const std::string& doc) {
  a.optional_section({"table", doc}, function.table);
}

}  // namespace

std::size_t particle_count(const GenerateSpec& generate) {
  double points = static_cast<double>(generate.count);
  if (generate.kind != "chain") {
    points = 1.0;
    for (const std::int64_t count : generate.counts) points *= static_cast<double>(count);
  }
  return static_cast<std::size_t>(std::min(points, 9e15));  // more are refused anyway
}

void declare(Archive& a, RayleighSpec& rayleigh) {
  a(setting("mass", rayleigh.mass).unit("1/s").nonnegative().doc("α: force −α m v on every particle"));
  a(setting("stiffness", rayleigh.stiffness)
        .unit("s")
        .nonnegative()
        .doc("β: every spring's damping gains β times its rate dσ/dL, every anchor's β k"));
}

void declare(Archive& a, TimeTableSpec& table) {
  a(setting("t", table.t).unit("s").required().not_empty().doc("rising times"));
  a(setting("value", table.value)
        .required()
        .not_empty()
        .doc("a vector per time; linear between them, constant before the first and after the last"));
}

void declare(Archive& a, WorldSpec& world) {
  a(setting("gravity", world.gravity).unit("m/s²").doc("acceleration"));
  a(setting("drag", world.drag).unit("kg/s").nonnegative().doc("force −drag·v on every particle"));
  a.optional_section(
      {"rayleigh", "Damping α M + β K of the springs' and anchors' stiffness K, as dampers along them."},
      world.rayleigh);
}

void declare(Archive& a, ParticlesSpec& particles) {
  a(setting("position", particles.position).unit("m").required().not_empty().doc("at the start"));
  a(setting("velocity", particles.velocity)
        .unit("m/s")
        .default_text("zero")
        .doc("at the start, one per particle; of a fixed particle it is set to zero, with a warning"));
  a(setting("mass", particles.mass)
        .unit("kg")
        .required()
        .positive()
        .or_one_per("particle", particles.position.size())
        .doc(""));
  a(setting("fixed", particles.fixed)
        .into("particle", particles.position.size())
        .doc("particles that never move"));
}

void declare(Archive& a, SpringsSpec& springs) {
  a(setting("between", springs.between)
        .required()
        .into("particle", springs.particles)
        .doc("may be empty; the same pair twice means two parallel springs"));
  const std::size_t count = springs.between.size();
  auto stiffness = setting("stiffness", springs.stiffness)
                       .unit("N/m")
                       .nonnegative()
                       .or_one_per("spring", count)
                       .doc("k_s; in newtons with the law `strain`");
  if (count > 0 || a.is_description()) {
    stiffness.required();
  } else {
    springs.stiffness = {0.0};
  }
  a(stiffness);
  a(setting("damping", springs.damping)
        .unit("N·s/m")
        .nonnegative()
        .or_one_per("spring", count)
        .doc("k_d, along the spring"));
  a(law_setting(springs.law).doc("see below, for all springs"));
  auto rest_length = setting("rest_length", springs.rest_length)
                         .unit("m")
                         .or_one_per("spring", count)
                         .default_text("distance at the start")
                         .doc("l₀; > 0 with `strain`; has to be given between coincident points");
  a(with_range(a, springs.law, rest_length));
}

void declare(Archive& a, SpringGroupSpec& group) {
  declare(a, group.springs);
  a(setting("name", group.name).doc("each name once"));
}

void declare(Archive& a, GenerateSpec& g) {
  const auto spacing = [&] {
    a(setting("spacing", g.spacing)
          .unit("m")
          .positive()
          .doc("distance of neighbouring points along every axis"));
  };
  const auto families = [&](const std::vector<std::string>& names, const std::vector<std::string>& chosen) {
    if (a.is_description() || !g.springs) g.springs = chosen;
    a(setting("springs", g.springs).choices(names).doc("the families of springs; may be empty"));
    const bool has_springs = a.is_description() || !g.springs->empty();
    const std::vector<std::string>& by_name = a.is_description() || !has_springs ? names : *g.springs;
    auto stiffness = setting("stiffness", g.stiffness)
                         .unit("N/m")
                         .nonnegative()
                         .or_by_name(by_name)
                         .doc("as in `[springs]`");
    if (has_springs) stiffness.required();
    a(stiffness);
    if (has_springs && !g.damping) g.damping = NumberTable{{"", 0.0}};
    a(setting("damping", g.damping).unit("N·s/m").nonnegative().or_by_name(by_name).doc("as in `[springs]`"));
  };
  const auto lattice = [&](std::size_t axes) {
    a(setting("counts", g.counts)
          .required()
          .entries(axes)
          .integers(2, largest_count)
          .doc("points along each axis"));
    a.one_of(
        {{"size",
          [&] { a(setting("size", g.size).unit("m").entries(axes).positive().doc("lengths of the edges")); }},
         {"spacing", spacing}});
  };
  a.by(setting("kind", g.kind)
           .required()
           .choices({"chain", "cloth", "grid", "block"})
           .doc("`mesh` is reserved and not available yet"),
       {{"chain",
         [&] {
           a(setting("count", g.count).required().integers(2, largest_count).doc("points"));
           a.one_of(
               {{"length", [&] { a(setting("length", g.length).unit("m").positive().doc("of the chain")); }},
                {"spacing", spacing}});
           a(setting("direction", g.direction).doc("≠ 0, of any length"));
           families({"structural", "bend"}, {"structural"});
         }},
        {"cloth",
         [&] {
           lattice(2);
           a(setting("plane", g.plane)
                 .choices({"xy", "xz", "yz"})
                 .doc("the axes to the right and up in the sheet"));
           families({"structural", "shear", "bend"}, {"structural", "shear", "bend"});
         }},
        {"grid",
         [&] {
           lattice(3);
           families({"structural", "shear", "bend", "cross_brace"}, {"structural", "shear"});
         }},
        {"block", [&] {
           lattice(3);
           families({"structural"}, {"structural"});
         }}});
  const std::size_t count = particle_count(g);
  a.one_of({{"mass",
             [&] {
               a(setting("mass", g.mass)
                     .unit("kg")
                     .positive()
                     .or_one_per("particle", count)
                     .doc("of every particle"));
             }},
            {"total_mass",
             [&] { a(setting("total_mass", g.total_mass).unit("kg").positive().doc("of the whole")); }},
            {"density", [&] {
               a(setting("density", g.density)
                     .positive()
                     .doc("[kg/m] for a chain, [kg/m²] for a cloth, [kg/m³] for grid and block"));
             }}});
  a(setting("origin", g.origin).unit("m").doc("place of the first point"));
  a(law_setting(g.law).doc("as in `[springs]`"));
  auto factor =
      setting("rest_length_factor", g.rest_length_factor)
          .unit("1")
          .doc("rest length = factor × distance at the start; < 1 is taut, > 1 slack; > 0 with `strain`");
  a(with_range(a, g.law, factor));
  a(setting("pinned", g.pinned)
        .choices(a.is_description() ? all_point_names() : point_names(g.kind))
        .into("particle", count)
        .doc("particles that never move"));
  a(setting("velocity", g.velocity).unit("m/s").doc("of all particles that are not pinned"));
}

void declare(Archive& a, AnchorSpec& anchor) {
  a(particle_setting(a, anchor));
  a(setting("stiffness", anchor.stiffness).unit("N/m").required().nonnegative().doc("k"));
  a(setting("damping", anchor.damping).unit("N·s/m").nonnegative().doc("c"));
  a(setting("position", anchor.position)
        .unit("m")
        .default_text("where the particle starts")
        .doc("x₀; only for a single particle"));
  a(setting("velocity", anchor.displacement.vector)
        .unit("m/s")
        .default_text("the support stands")
        .doc("of a support that moves: x₀ + velocity·t; at most one of this, `table` and `expression`"));
  a(setting("expression", anchor.displacement.expression)
        .entries(3)
        .default_text("the support stands")
        .doc("displacement of the support from x₀ [m], three expressions of t"));
  declare_table(a, anchor.displacement, "Displacement of the support from x₀ [m] over time.");
}

void declare(Archive& a, ForceSpec& force) {
  a(particle_setting(a, force));
  a(setting("value", force.force.vector)
        .unit("N")
        .default_text("none")
        .doc("a constant force; exactly one of this, `table` and `expression`"));
  a(setting("expression", force.force.expression)
        .entries(3)
        .default_text("none")
        .doc("the force [N], three expressions of t"));
  declare_table(a, force.force, "The force [N] over time.");
}

void declare(Archive& a, ObstacleSpec& o) {
  a.by(
      setting("shape", o.shape).required().choices({"plane", "sphere", "box"}).doc("of the solid"),
      {{"plane",
        [&] {
          a(setting("point", o.point).unit("m").required().doc("of the surface"));
          a(setting("normal", o.normal).required().doc("≠ 0, the direction out of the solid, of any length"));
        }},
       {"sphere",
        [&] {
          a(setting("centre", o.centre).unit("m").required().doc(""));
          a(setting("radius", o.radius).unit("m").required().positive().doc(""));
        }},
       {"box", [&] {
          a(setting("lower", o.lower).unit("m").required().doc("corner of the axis-parallel box"));
          a(setting("upper", o.upper).unit("m").required().doc("the opposite corner, each component larger"));
        }}});
  a(setting("stiffness", o.stiffness).unit("N/m").required().nonnegative().doc("k"));
  a(setting("damping", o.damping).unit("N·s/m").nonnegative().doc("c"));
}

void declare(Archive& a, SceneSpec& scene) {
  a(setting("title", scene.title).doc("for people"));
  a(setting("start", scene.start)
        .choices({"given", "equilibrium"})
        .default_text("`\"given\"`")
        .doc("positions at the start: those given, or the static equilibrium that Newton's iteration finds "
             "from "
             "them; velocities are those given"));
  a.section({"world", "What acts on every particle."}, scene.world);
  a.optional_section({"generate", "A standard system, in place of [particles] and [springs]."},
                     scene.generate);
  a.optional_section({"particles", "All particles one by one."}, scene.particles);
  SpringsSpec springs;
  springs.particles = scene.particles ? scene.particles->position.size() : 0;
  a.section_or_sections({"springs", "Springs between them; may be absent: free particles."}, scene.springs,
                        springs, {"springs", "Groups of springs, each with a law of its own."},
                        scene.spring_groups, SpringGroupSpec{springs, ""});
  AnchorSpec anchor;
  anchor.particles = scene.generate ? particle_count(*scene.generate) : springs.particles;
  anchor.point_names = point_names(scene.generate ? scene.generate->kind : "");
  a.sections({"anchor", "Force −k (x − x₀) − c v on particles; x₀ may move, v is then relative to it."},
             scene.anchors, anchor);
  ForceSpec force;
  force.particles = anchor.particles;
  force.point_names = anchor.point_names;
  a.sections({"force", "A force on each of some particles, constant or over time."}, scene.forces, force);
  a.sections({"obstacle",
              "A solid that pushes particles out: force max(k δ − c v·n, 0) n at depth δ with outward "
              "normal n."},
             scene.obstacles);
}

}  // namespace fw::scene
