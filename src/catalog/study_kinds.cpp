#include "catalog/study_kinds.hpp"

#include "study/energy/energy.hpp"
#include "study/jacobian/jacobian.hpp"
#include "study/kinds/agreement.hpp"
#include "study/kinds/convergence.hpp"
#include "study/kinds/dissipation.hpp"
#include "study/kinds/simulate.hpp"
#include "study/kinds/sweep.hpp"
#include "study/linear_solver/linear_solver.hpp"
#include "study/propagation/propagation.hpp"
#include "study/stability/stability.hpp"
#include "study/stiffness/stiffness.hpp"
#include "study/verification/verify.hpp"
#include "study/work_precision/work_precision.hpp"

namespace fw::catalog {

namespace {

/// Every kind but the one that is made of the others.
std::vector<study::StudyKind> plain_kinds() {
  return {study::convergence_kind(),   study::agreement_kind(),      study::stability_kind(),
          study::stiffness_kind(),     study::work_precision_kind(), study::energy_kind(),
          study::dissipation_kind(),   study::propagation_kind(),    study::jacobian_kind(),
          study::linear_solver_kind(), study::simulate_kind(),       study::verify_kind()};
}

std::vector<study::StudyKind> all_kinds() {
  std::vector<study::StudyKind> kinds = plain_kinds();
  kinds.push_back(study::sweep_kind(plain_kinds()));
  return kinds;
}

}  // namespace

const std::vector<study::StudyKind>& study_kinds() {
  static const std::vector<study::StudyKind> list = all_kinds();
  return list;
}

}  // namespace fw::catalog
