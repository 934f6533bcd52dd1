#include "integrators/tableau/tableau_info.hpp"

#include "schemes/derived_properties.hpp"
#include "schemes/order_conditions.hpp"
#include "schemes/stability_function.hpp"

namespace fw::integrators {

MethodInfo tableau_info(const schemes::ButcherTableau& tableau, const std::string& family) {
  schemes::check_tableau(tableau);
  MethodInfo info{
      .name = tableau.name, .title = tableau.title, .family = family, .reference = tableau.reference};
  info.order = info.order_with_velocity_forces = schemes::order_of_accuracy(tableau);
  info.embedded_order = schemes::embedded_order(tableau);
  info.is_adaptive = !tableau.b_embedded.empty();
  info.stages = tableau.stages();
  info.is_symplectic = schemes::is_symplectic(tableau);
  info.is_symmetric = schemes::is_symmetric(tableau);
  const schemes::LinearStability stability = linear_stability(stability_function(tableau));
  info.is_a_stable = stability.is_a_stable;
  info.is_l_stable = stability.is_l_stable;
  info.is_explicit = schemes::shape(tableau) == schemes::TableauShape::explicit_stages;
  return info;
}

}  // namespace fw::integrators
