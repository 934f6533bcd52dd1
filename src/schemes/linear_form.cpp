#include "schemes/linear_form.hpp"

namespace fw::schemes {

namespace {

LinearForm form_of(std::monostate) {
  return {};
}
LinearForm form_of(const AdditiveTableau&) {
  return {};
}
LinearForm form_of(const ButcherTableau& tableau) {
  return stability_function(tableau);
}
LinearForm form_of(const RosenbrockTableau& tableau) {
  return stability_function(tableau);
}
LinearForm form_of(const NystromTableau& tableau) {
  return values<Float128>(tableau);
}
LinearForm form_of(const SplittingScheme& scheme) {
  return as_nystrom(scheme);
}
LinearForm form_of(const MultistepFormula& formula) {
  return formula;
}

}  // namespace

LinearForm linear_form(const SchemeData& data) {
  return std::visit([](const auto& scheme) { return form_of(scheme); }, data);
}

}  // namespace fw::schemes
