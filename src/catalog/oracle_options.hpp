#pragma once

#include <string>
#include <vector>

#include "oracles/gsl/odeiv2.hpp"
#include "oracles/petsc/time_steppers.hpp"
#include "oracles/sundials/arkode.hpp"
#include "oracles/sundials/arkode_mri.hpp"
#include "oracles/sundials/cvode.hpp"
#include "oracles/sundials/ida.hpp"
#include "settings/archive.hpp"

namespace fw::oracles {

/// The options of foreign solvers, as they stand in brackets.
void declare(settings::Archive& a, GslOptions& options);
void declare(settings::Archive& a, IdaOptions& options);
void declare(settings::Archive& a, MriOptions& options);
void declare(settings::Archive& a, TsRkOptions& options);
void declare(settings::Archive& a, TsThetaOptions& options);
void declare(settings::Archive& a, TsBdfOptions& options);
void declare(settings::Archive& a, TsArkimexOptions& options);
void declare(settings::Archive& a, TsRoswOptions& options);
void declare(settings::Archive& a, TsAlpha2Options& options);
void declare(settings::Archive& a, TsBasicSymplecticOptions& options);

}  // namespace fw::oracles

namespace fw::catalog {

/// The options of CVODE with one of its formulas; `iteration` and `maximum_order` have a value.
struct CvodeCall {
  oracles::CvodeFormula formula = oracles::CvodeFormula::bdf;
  oracles::CvodeOptions options{};
};
void declare(settings::Archive& a, CvodeCall& call);

/// The options of one of ARKODE's one-step methods.
struct ArkodeCall {
  std::vector<std::string> tables{}, tableaus{};  ///< that there are: ARKODE's and ours
  bool is_implicit = false;
  std::string table{};    ///< one of ARKODE's
  std::string tableau{};  ///< one of ours in place of it; empty: none
  oracles::ArkodeOptions options{};
};
void declare(settings::Archive& a, ArkodeCall& call);

}  // namespace fw::catalog
