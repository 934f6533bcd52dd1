#include "integrators/graphics/explicit_external_force.hpp"

#include <fmt/format.h>

#include "ode/not_applicable.hpp"

namespace fw::integrators {

using Part = mechanics::BatchChoice::Part;

ExplicitExternalForce::ExplicitExternalForce(const mechanics::MassSpringSystem& system, Dampers dampers,
                                             std::string_view method)
    : system_(system),
      dampers_(dampers),
      method_(method),
      revision_(system.element_revision()),
      zero_(Vector::Zero(system.degrees_of_freedom())) {
  choose();
}

void ExplicitExternalForce::choose() {
  const mechanics::ElementAssembly& elements = system_.elements();
  revision_ = system_.element_revision();
  external_.assign(elements.batch_count(), {});
  elastic_.assign(elements.batch_count(), {});
  for (std::size_t k = 0; k < elements.batch_count(); ++k) {
    const mechanics::ElementLabels labels = elements.labels(k);
    if (labels.role == mechanics::ElementRole::external) {
      elastic_[k].part = Part::none;
      continue;
    }
    if (labels.kind != "springs" && labels.kind != "anchors") {
      throw NotApplicable(fmt::format(
          "method \"{}\": found {}, expected springs and anchors alone to be elastic", method_, labels.kind));
    }
    const bool has_dampers = elements.force_class(k) == ForceClass::velocity;
    external_[k].part = has_dampers && dampers_ == Dampers::to_external ? Part::dampers : Part::none;
  }
}

void ExplicitExternalForce::evaluate(double t, ConstVectorRef q, ConstVectorRef v, VectorRef force) {
  if (revision_ != system_.element_revision()) choose();
  system_.elements().force(external_, q.data(), v.data(), force.data());
  system_.add_driving_force(t, force);
}

void ExplicitExternalForce::elastic(ConstVectorRef q, VectorRef force) {
  if (revision_ != system_.element_revision()) choose();
  system_.elements().force(elastic_, q.data(), zero_.data(), force.data());
}

}  // namespace fw::integrators
