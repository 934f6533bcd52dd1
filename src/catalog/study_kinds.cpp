#include "catalog/study_kinds.hpp"

#include "study/agreement.hpp"
#include "study/convergence.hpp"
#include "study/dissipation.hpp"
#include "study/energy.hpp"
#include "study/linear_solver.hpp"
#include "study/propagation.hpp"
#include "study/simulate.hpp"

namespace fw::catalog {

const std::vector<study::StudyKind>& study_kinds() {
  static const std::vector<study::StudyKind> list = {
      study::convergence_kind(), study::agreement_kind(),     study::dissipation_kind(), study::energy_kind(),
      study::propagation_kind(), study::linear_solver_kind(), study::simulate_kind()};
  return list;
}

}  // namespace fw::catalog
