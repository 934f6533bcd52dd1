#include "scene/scene_spec.hpp"

#include <algorithm>

#include "scene/point_groups.hpp"

namespace fw::scene {

using settings::Archive;
using settings::setting;

namespace {

constexpr std::int64_t largest_count = 2147483647;

const std::vector<std::string> laws = {"hooke", "strain", "tension_only"};

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

}  // namespace

void declare(Archive& a, WorldSpec& world) {
  a(setting("gravity", world.gravity).unit("m/s²").doc("acceleration"));
  a(setting("drag", world.drag).unit("kg/s").nonnegative().doc("force −drag·v on every particle"));
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
  a(setting("stiffness", springs.stiffness)
        .unit("N/m")
        .required()
        .nonnegative()
        .or_one_per("spring", count)
        .doc("k_s; in newtons with the law `strain`"));
  a(setting("damping", springs.damping)
        .unit("N·s/m")
        .nonnegative()
        .or_one_per("spring", count)
        .doc("k_d, along the spring"));
  a(setting("rest_length", springs.rest_length)
        .unit("m")
        .nonnegative()
        .or_one_per("spring", count)
        .default_text("distance at the start")
        .doc("l₀; > 0 with `strain`; has to be given between coincident points"));
  a(setting("law", springs.law).choices(laws).doc("see below, for all springs"));
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
    if (a.is_description()) g.springs = chosen;
    a(setting("springs", g.springs).choices(names).doc("the families of springs; may be empty"));
    a(setting("stiffness", g.stiffness)
          .unit("N/m")
          .required()
          .nonnegative()
          .or_by_name(names)
          .doc("as in `[springs]`"));
    a(setting("damping", g.damping).unit("N·s/m").nonnegative().or_by_name(names).doc("as in `[springs]`"));
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
  a.one_of(
      {{"mass",
        [&] {
          a(setting("mass", g.mass).unit("kg").positive().or_one_per("particle", 0).doc("of every particle"));
        }},
       {"total_mass",
        [&] { a(setting("total_mass", g.total_mass).unit("kg").positive().doc("of the whole")); }},
       {"density", [&] {
          a(setting("density", g.density)
                .positive()
                .doc("[kg/m] for a chain, [kg/m²] for a cloth, [kg/m³] for grid and block"));
        }}});
  a(setting("origin", g.origin).unit("m").doc("place of the first point"));
  a(setting("rest_length_factor", g.rest_length_factor)
        .unit("1")
        .nonnegative()
        .doc("rest length = factor × distance at the start; < 1 is taut, > 1 slack; > 0 with `strain`"));
  a(setting("law", g.law).choices(laws).doc("as in `[springs]`"));
  a(setting("pinned", g.pinned)
        .choices(all_point_names())
        .into("particle", 0)
        .doc("particles that never move"));
  a(setting("velocity", g.velocity).unit("m/s").doc("of all particles that are not pinned"));
}

void declare(Archive& a, AnchorSpec& anchor) {
  a(setting("particle", anchor.particle)
        .required()
        .choices(all_point_names())
        .into("particle", 0)
        .doc("names as for `pinned`; a scene with `[particles]` has the name `all` only"));
  a(setting("stiffness", anchor.stiffness).unit("N/m").required().nonnegative().doc("k"));
  a(setting("damping", anchor.damping).unit("N·s/m").nonnegative().doc("c"));
  a(setting("position", anchor.position)
        .unit("m")
        .default_text("where the particle starts")
        .doc("x₀; only for a single particle"));
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
  a.section({"world", "What acts on every particle."}, scene.world);
  a.optional_section({"generate", "A standard system, in place of [particles] and [springs]."},
                     scene.generate);
  a.optional_section({"particles", "All particles one by one."}, scene.particles);
  a.optional_section({"springs", "Springs between them; may be absent: free particles."}, scene.springs);
  a.sections({"springs", "Groups of springs, each with a law of its own."}, scene.spring_groups);
  a.sections({"anchor", "Force −k (x − x₀) − c v on particles."}, scene.anchors);
  a.sections({"obstacle",
              "A solid that pushes particles out: force max(k δ − c v·n, 0) n at depth δ with outward "
              "normal n."},
             scene.obstacles);
}

}  // namespace fw::scene
