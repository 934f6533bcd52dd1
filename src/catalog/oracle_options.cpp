#include "catalog/oracle_options.hpp"

namespace fw::oracles {

using settings::Archive;
using settings::choice;
using settings::setting;

namespace {

/// More steps inside of a step than anybody waits for.
constexpr int most_inner_steps = 1'000'000;

void declare_tolerance_factor(Archive& a, double& factor, const std::string& library) {
  a(setting("tolerance_factor", factor)
        .above(0.0)
        .up_to(1.0)
        .doc(library + "'s own tolerances as a fraction of those given"));
}

void declare_petsc(Archive& a, std::string& options) {
  a(setting("petsc", options).doc("further options in PETSc's notation, without commas"));
}

void declare_type(Archive& a, std::string& type, const std::vector<TsType>& types) {
  std::vector<std::string> names;
  for (const TsType& one : types) names.push_back(one.name);
  a(setting("type", type).choices(names).doc("scheme, as PETSc calls it"));
}

}  // namespace

void declare(Archive& a, GslOptions& options) {
  declare_tolerance_factor(a, options.tolerance_factor, "GSL");
}

void declare(Archive& a, IdaOptions& options) {
  declare_tolerance_factor(a, options.tolerance_factor, "IDA");
}

void declare(Archive& a, MriOptions& options) {
  a(setting("coupling", options.coupling)
        .choices(arkode_couplings())
        .doc("how slow and fast forces are coupled, as ARKODE calls it"));
  a(choice("inner", options.inner_is_implicit, {{"explicit", false}, {"implicit", true}})
        .doc("how stiff forces are integrated"));
  std::vector<std::string> tables = arkode_explicit_tables();
  if (options.inner_is_implicit) tables = arkode_diagonally_implicit_tables();
  if (a.is_description()) {
    for (const std::string& name : arkode_diagonally_implicit_tables()) tables.push_back(name);
  }
  a(setting("inner_table", options.inner_table)
        .choices(tables)
        .default_text("one of the coupling's order or more")
        .doc("one of ARKODE's own tables for them, explicit or diagonally implicit as `inner` says"));
  a(setting("inner_steps", options.inner_steps)
        .integers(0, most_inner_steps)
        .doc("constant inner steps per step; 0: chosen by inner_tolerance"));
  a(setting("inner_tolerance", options.inner_tolerance).above(0.0).up_to(1.0).doc("relative to the state"));
}

void declare(Archive& a, TsRkOptions& options) {
  declare_type(a, options.type, ts_rk_types());
  declare_petsc(a, options.petsc);
}

void declare(Archive& a, TsThetaOptions& options) {
  a(setting("theta", options.theta).above(0.0).up_to(1.0).doc("1: implicit Euler"));
  a(choice("endpoint", options.endpoint, {{"no", false}, {"yes", true}}).doc("yes: the trapezoidal family"));
  declare_petsc(a, options.petsc);
}

void declare(Archive& a, TsBdfOptions& options) {
  a(setting("order", options.order).integers(1, 6).doc("of the formula"));
  declare_tolerance_factor(a, options.tolerance_factor, "PETSc");
  declare_petsc(a, options.petsc);
}

void declare(Archive& a, TsArkimexOptions& options) {
  declare_type(a, options.type, ts_arkimex_types());
  a(choice("splitting", options.splitting, {{"no", false}, {"yes", true}})
        .doc("yes: stiff springs implicit, the rest explicit"));
  declare_petsc(a, options.petsc);
}

void declare(Archive& a, TsRoswOptions& options) {
  declare_type(a, options.type, ts_rosw_types());
  declare_petsc(a, options.petsc);
}

void declare(Archive& a, TsAlpha2Options& options) {
  a(setting("rho_infinity", options.rho_infinity)
        .between(0.0, 1.0)
        .doc("spectral radius at infinite frequency"));
  declare_petsc(a, options.petsc);
}

void declare(Archive& a, TsBasicSymplecticOptions& options) {
  a(setting("order", options.order).integers(1, 4).doc("of the scheme"));
  declare_petsc(a, options.petsc);
}

}  // namespace fw::oracles

namespace fw::catalog {

using settings::choice;
using settings::setting;

void declare(settings::Archive& a, CvodeCall& call) {
  using oracles::CvodeIteration;
  using oracles::CvodeLinearSolver;
  using oracles::VectorOperations;
  oracles::CvodeOptions& options = call.options;
  const bool is_bdf = call.formula == oracles::CvodeFormula::bdf;
  oracles::declare_tolerance_factor(a, options.tolerance_factor, "CVODE");
  a(choice("nonlinear_solver", options.iteration,
           {{"newton", CvodeIteration::newton}, {"fixed_point", CvodeIteration::fixed_point}})
        .doc("of the implicit equation of a step"));
  a(choice("linear_solver", options.linear_solver,
           {{"klu", CvodeLinearSolver::klu}, {"spgmr", CvodeLinearSolver::spgmr}})
        .doc("of Newton's iteration: sparse LU, or GMRES with particle blocks"));
  a(setting("krylov_dimension", options.krylov_dimension).integers(1, 10'000).doc("of spgmr"));
  a(setting("max_order", options.maximum_order).integers(1, is_bdf ? 5 : 12).doc("of the formula"));
  a(choice("vector", options.vector,
           {{"eigen", VectorOperations::eigen}, {"serial", VectorOperations::serial}})
        .doc("vector operations: ours, or SUNDIALS'"));
  if (!is_bdf) return;
  a(choice("stability_limit_detection", options.stability_limit_detection, {{"off", false}, {"on", true}})
        .doc("lowers the order near the imaginary axis"));
}

void declare(settings::Archive& a, ArkodeCall& call) {
  a(setting("table", call.table).choices(call.tables).doc("one of ARKODE's own tables"));
  a(setting("tableau", call.tableau)
        .choices(call.tableaus)
        .default_text("none")
        .doc("one of ours, in place of the table"));
  oracles::declare_tolerance_factor(a, call.options.tolerance_factor, "ARKODE");
  if (!call.is_implicit) return;
  a(setting("newton_coefficient", call.options.newton_coefficient)
        .above(0.0)
        .up_to(1.0)
        .doc("with chosen steps: what Newton's iteration may leave, as a fraction of the tolerances"));
  a(setting("newton_tolerance", call.options.newton_tolerance)
        .above(0.0)
        .up_to(1.0)
        .doc("with constant steps: what it may leave, relative to the state"));
}

}  // namespace fw::catalog
