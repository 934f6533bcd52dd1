#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "mechanics/assembly/node_access.hpp"
#include "mechanics/elements/path_piece.hpp"
#include "ode/switching_surfaces.hpp"

namespace fw::mechanics {

/// A batch whose elements announce where their forces switch, by
///  - `phase(e, x, v)` over the scalar, see `Switch`;
///  - `stays(e, phase, paths)`: whether an element that begins in `phase` is in it all along; false where that
///    cannot be told;
///  - `kink(e, from, to, x, v, speed, acceleration)`: what the force jumps by;
///  - `switch_number(e)`: what the element is called by, the number of its obstacle or spring.
template <class Batch>
concept HasSwitches = requires(const Batch& batch, const std::array<Vec3<double>, Batch::arity>& x) {
  batch.phase(std::size_t{0}, x, x);
};

/// What a search looks at.
template <class Scalar>
struct SwitchQuery {
  const StatePath<Scalar>& path;
  const std::vector<double>& mass;    ///< per particle [kg]
  const std::vector<char>& is_fixed;  ///< per particle
};

/// The search along the path of one element.
template <class Batch, class Scalar>
class SwitchSearch {
 public:
  static constexpr auto nodes = static_cast<std::size_t>(Batch::arity);
  using Paths = NodePaths<Scalar, nodes>;
  using Vectors = std::array<Vec3<Scalar>, nodes>;

  SwitchSearch(const Batch& batch, std::size_t element, int phase)
      : batch_(batch), element_(element), phase_(phase) {}

  /// Finds the first place on [from, from + width] of the step (in units of it) in another phase. Halves the path
  /// until each piece stays in the phase by its hull, or switches within the resolution of the scalar. Near a
  /// surface that is crossed or touched a few pieces are left on each level; a path that follows one, closer than
  /// its hull but outside rounding, is given up after a while.
  bool find(const Paths& paths, const Scalar& from, const Scalar& width, int depth = 0) {
    if (batch_.stays(element_, phase_, paths)) return false;
    const Vectors x = ends(paths), v = end_velocities(paths);
    const int at_end = batch_.phase(element_, x, v);
    const bool switches = at_end != phase_;
    if (switches && (width <= resolution() || depth >= deepest)) {
      place_ = from + width;
      phase_after_ = at_end;
      x_ = x;
      v_ = v;
      return true;
    }
    if (!switches && (depth >= deepest || --pieces_left_ < 0)) return false;
    const Scalar half = width / 2;
    std::array<Paths, 2> parts;
    for (std::size_t a = 0; a < nodes; ++a) {
      const auto both = halves(paths[a]);
      parts[0][a] = both[0];
      parts[1][a] = both[1];
    }
    return find(parts[0], from, half, depth + 1) || find(parts[1], from + half, half, depth + 1);
  }

  /// The switch is at the end of the step.
  void found_at_end(int phase, const Vectors& x, const Vectors& v) {
    place_ = 1;
    phase_after_ = phase;
    x_ = x;
    v_ = v;
  }

  const Scalar& place() const { return place_; }
  int phase_after() const { return phase_after_; }
  const Vectors& x() const { return x_; }
  const Vectors& v() const { return v_; }

 private:
  static constexpr int deepest = std::numeric_limits<Scalar>::digits;
  static Scalar resolution() { return std::numeric_limits<Scalar>::epsilon(); }
  static Vectors ends(const Paths& paths) {
    Vectors x;
    for (std::size_t a = 0; a < nodes; ++a) x[a] = paths[a].x[3];
    return x;
  }
  static Vectors end_velocities(const Paths& paths) {
    Vectors v;
    for (std::size_t a = 0; a < nodes; ++a) v[a] = paths[a].v[2];
    return v;
  }

  const Batch& batch_;
  std::size_t element_;
  int phase_;
  int pieces_left_ = 8 * deepest;  ///< that neither stay nor switch, of a path that follows a surface
  Scalar place_{};
  int phase_after_ = 0;
  Vectors x_{}, v_{};
};

template <class Scalar, std::size_t N>
std::array<Vec3<double>, N> rounded(const std::array<Vec3<Scalar>, N>& vectors) {
  std::array<Vec3<double>, N> result;
  for (std::size_t a = 0; a < N; ++a) {
    result[a] = {static_cast<double>(vectors[a].x), static_cast<double>(vectors[a].y),
                 static_cast<double>(vectors[a].z)};
  }
  return result;
}

/// The first switch of one element along the path, if any, to `sink`.
template <class Batch, class Scalar>
void search_switch(const Batch& batch, std::size_t e, const SwitchQuery<Scalar>& query, SwitchSink<Scalar>& sink) {
  constexpr auto nodes = static_cast<std::size_t>(Batch::arity);
  const auto index = batch.nodes(e);
  const std::size_t n = 3 * query.mass.size();
  const auto x0 = gather(query.path.from, index), x1 = gather(query.path.to, index);
  auto v0 = gather(query.path.from + n, index), v1 = gather(query.path.to + n, index);
  double lightest = std::numeric_limits<double>::infinity();
  NodePaths<Scalar, nodes> paths;
  for (std::size_t a = 0; a < nodes; ++a) {
    const auto i = static_cast<std::size_t>(index[a]);
    if (query.is_fixed[i] != 0) {
      v0[a] = v1[a] = {};
    } else {
      lightest = std::min(lightest, query.mass[i]);
    }
    paths[a] = hermite_path(x0[a], v0[a], x1[a], v1[a], query.path.length);
  }
  const int phase = batch.phase(e, x0, v0);
  if (!std::isfinite(lightest)) return;  // nothing moves
  SwitchSearch<Batch, Scalar> search(batch, e, phase);
  if (batch.stays(e, phase, paths)) {
    const int at_end = batch.phase(e, x1, v1);
    if (at_end == phase) return;
    search.found_at_end(at_end, x1, v1);  // by less than rounding
  } else if (!search.find(paths, Scalar(0), Scalar(1))) {
    return;
  }
  double speed = 0.0, change = 0.0;
  for (std::size_t a = 0; a < nodes; ++a) {
    for (const auto& v : paths[a].v) speed = std::max(speed, static_cast<double>(norm(v)));
    change = std::max(change, static_cast<double>(norm(v1[a] - v0[a])));
  }
  const auto relative = static_cast<double>(nodes) * speed;
  const Kink kink = batch.kink(e, phase, search.phase_after(), rounded(search.x()), rounded(search.v()), relative,
                               change / static_cast<double>(query.path.length));
  Switch<Scalar> found{.offset = search.place() * query.path.length,
                       .from = phase,
                       .to = search.phase_after(),
                       .at_end = batch.phase(e, x1, v1),
                       .jump = kink.jump / lightest,
                       .rate = kink.rate / lightest,
                       .frequency = std::sqrt(kink.stiffness / lightest),
                       .speed = speed,
                       .thickness = kink.thickness,
                       .kind = Batch::labels.kind,
                       .number = batch.switch_number(e)};
  for (std::size_t a = 0; a < nodes && a < 2; ++a) found.nodes[a] = index[a];
  sink.add(found);
}

template <class Batch, class Scalar>
void search_switches(const Batch& batch, const SwitchQuery<Scalar>& query, SwitchSink<Scalar>& sink) {
  const std::size_t size = batch.size();
  for (std::size_t e = 0; e < size; ++e) search_switch(batch, e, query, sink);
}

/// The elements that act at the start of the path, see `SwitchingSurfaces::acting`.
template <class Batch>
void list_acting(const Batch& batch, const SwitchQuery<double>& query, SwitchSink<double>& sink) {
  constexpr auto nodes = static_cast<std::size_t>(Batch::arity);
  const std::size_t n = 3 * query.mass.size(), size = batch.size();
  for (std::size_t e = 0; e < size; ++e) {
    const auto index = batch.nodes(e);
    const auto x = gather(query.path.from, index);
    auto v = gather(query.path.from + n, index);
    double lightest = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < nodes; ++a) {
      const auto i = static_cast<std::size_t>(index[a]);
      if (query.is_fixed[i] != 0) {
        v[a] = {};
      } else {
        lightest = std::min(lightest, query.mass[i]);
      }
    }
    const int phase = batch.phase(e, x, v);
    if (phase == 0) continue;
    const Kink kink = batch.kink(e, 0, phase, x, v, 0.0, 0.0);
    Switch<double> found{.to = phase,
                         .at_end = phase,
                         .frequency = std::sqrt(kink.stiffness / lightest),
                         .thickness = kink.thickness,
                         .kind = Batch::labels.kind,
                         .number = batch.switch_number(e)};
    for (std::size_t a = 0; a < nodes && a < 2; ++a) found.nodes[a] = index[a];
    sink.add(found);
  }
}

}  // namespace fw::mechanics
